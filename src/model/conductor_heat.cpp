// Notation: T temperature in °C, c conductor, s surface, a air, f film (mean of s and a); q heat in
// W/m; Nu, Re, Pr, Ra Nusselt, Reynolds, Prandtl, Rayleigh number.

#include "tethercalc/model/conductor_heat.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <numbers>

#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

using std::numbers::pi;

/// W/(m²·K⁴), CODATA 2018 (exact since the SI of 2019).
constexpr double stefan_boltzmann = 5.670374419e-8;

constexpr double emissivity = 0.9;    // CIGRE TB 601: 0.8 to 0.9 for weathered surfaces
constexpr double absorptivity = 0.9;  // likewise
constexpr double pair_surface_share = (pi + 2) / (2 * pi);
constexpr double steepest_known_inclination = pi / 3;
const double hanging_in_still_air = cigre601_inclination_factor(steepest_known_inclination);

double kelvin(double celsius) { return celsius + zero_celsius_K; }

/// The root of `f` between lo and hi, f(lo) < 0 ≤ f(hi). 1e-12 of a few hundred kelvin.
template <typename Function>
double root_between(const Function& f, double lo, double hi, double at_lo, double at_hi) {
  if (at_hi == 0) return hi;
  const auto close = [](double a, double b) { return std::abs(b - a) <= 1e-11; };
  std::uintmax_t steps = 100;
  const auto [a, b] = boost::math::tools::toms748_solve(f, lo, hi, at_lo, at_hi, close, steps);
  return 0.5 * (a + b);
}

/// The first root of `f` from `from` on, which is `from` itself where f(from) ≥ 0, up to `to`;
/// nothing where there is none. Looks at every 5 K at least: two roots that lie closer are a state
/// on the brink of running away, and are taken for one that has.
template <typename Function>
std::optional<double> first_root(const Function& f, double from, double to) {
  constexpr double longest_stride = 5;
  double stride = 0.5;
  double lo = from;
  double at_lo = f(lo);
  if (at_lo >= 0) return lo;
  while (lo < to) {
    const double hi = std::min(lo + stride, to);
    stride = std::min(2 * stride, longest_stride);
    const double at_hi = f(hi);
    if (at_hi >= 0) return root_between(f, lo, hi, at_lo, at_hi);
    lo = hi;
    at_lo = at_hi;
  }
  return std::nullopt;
}

/// Of air, CIGRE TB 601: a polynomial over the temperature in °C.
struct Polynomial {
  double c0, c1, c2;
  [[nodiscard]] constexpr double at(double t) const { return c0 + t * (c1 + t * c2); }
  [[nodiscard]] constexpr double slope(double t) const { return c1 + 2 * t * c2; }
};
constexpr Polynomial conductivity_of_air{2.368e-2, 7.23e-5, -2.763e-8};
constexpr Polynomial viscosity_of_air{17.239e-6, 4.635e-8, -2.03e-11};
constexpr double expansion_of_air = 0.00367;

double density_at_zero(const Surroundings& around) {
  return around.air_density * (1 + expansion_of_air * around.temperature_C);
}

/// A Nusselt number, and its derivatives by the logarithms of what it depends on.
struct Nusselt {
  double value = 0;
  double by_flow = 0;  ///< by ln Re, or ln Ra
  double by_prandtl = 0;
  double by_slenderness = 0;  ///< by ln of diameter over height, at the same Ra of the diameter
};

Nusselt operator*(double share, const Nusselt& whole) {
  return {share * whole.value, share * whole.by_flow, share * whole.by_prandtl,
          share * whole.by_slenderness};
}

// Roots and logarithms in place of powers: they take less time.
Nusselt forced_convection(double reynolds, double prandtl) {
  const double root = std::cbrt(prandtl);
  const double hinder = 0.5428835233189814 / (root * root);  // (0.4/Pr)^(2/3)
  const double eighth = std::sqrt(std::sqrt(std::sqrt(reynolds / 282000)));
  const double fourth = eighth * eighth;
  const double turbulence = fourth * fourth * eighth;  // (Re/282000)^(5/8)
  const double excess = 0.62 * std::sqrt(reynolds) * root / std::sqrt(std::sqrt(1 + hinder)) *
                        std::pow(1 + turbulence, 0.8);
  return {0.3 + excess, excess * 0.5 * (1 + turbulence / (1 + turbulence)),
          excess * (1.0 / 3 + hinder / (6 * (1 + hinder)))};
}

Nusselt natural_convection(double rayleigh, double prandtl) {
  const double hinder = std::exp(9.0 / 16 * std::log(0.559 / prandtl));
  const double part = 0.387 * std::exp(std::log(rayleigh) / 6 - 8.0 / 27 * std::log(1 + hinder));
  const double root = 0.6 + part;
  return {root * root, root * part / 3, root * part * hinder / (3 * (1 + hinder))};
}

Nusselt vertical_convection(double rayleigh, double prandtl, double slenderness) {
  const double thinning = 20 + 21 * prandtl;
  const double layer =
      4.0 / 3 * std::sqrt(std::sqrt(1.4 * rayleigh * prandtl * slenderness / thinning));
  const double below = 64 + 63 * prandtl;
  return {layer + 4 * (272 + 315 * prandtl) / (35 * below), 0.25 * layer,
          0.25 * layer * 20 / thinning + prandtl * 4 * 3024 / (35 * below * below), 0.25 * layer};
}

/// The greater of a horizontal cylinder's across and a vertical one's along an inclined conductor.
Nusselt inclined_convection(double rayleigh, double prandtl, double slenderness,
                            double inclination) {
  const Nusselt across = natural_convection(rayleigh * std::cos(inclination), prandtl);
  const Nusselt along = vertical_convection(rayleigh * std::sin(inclination), prandtl, slenderness);
  return across.value > along.value ? across : along;
}

}  // namespace

AirProperties air_properties(double film_temperature_C, double density_at_0C) {
  const double conductivity = conductivity_of_air.at(film_temperature_C);
  const double viscosity = viscosity_of_air.at(film_temperature_C);
  // The density at 0 °C over that of the film.
  const double expansion = 1 + expansion_of_air * film_temperature_C;
  return {conductivity, viscosity * expansion / density_at_0C, 1005 * viscosity / conductivity};
}

double churchill_bernstein(double reynolds, double prandtl) {
  return forced_convection(reynolds, prandtl).value;
}

double churchill_chu(double rayleigh, double prandtl) {
  return natural_convection(rayleigh, prandtl).value;
}

double slender_vertical_cylinder(double rayleigh, double prandtl, double slenderness) {
  return vertical_convection(rayleigh, prandtl, slenderness).value;
}

double cigre601_attack_factor(double angle) {
  const double sine = std::sin(angle);
  return angle <= 24 * unit::degree ? 0.42 + 0.68 * std::pow(sine, 1.08)
                                    : 0.42 + 0.58 * std::pow(sine, 0.9);
}

double cigre601_inclination_factor(double inclination) {
  return 1 - 1.58e-4 * std::pow(inclination / unit::degree, 1.5);
}

double radiated_heat(double perimeter, double surface_emissivity, double surface_C,
                     double ambient_C) {
  const auto fourth_power = [](double x) { return x * x * x * x; };
  return perimeter * surface_emissivity * stefan_boltzmann *
         (fourth_power(kelvin(surface_C)) - fourth_power(kelvin(ambient_C)));
}

ConductorHeat::ConductorHeat(const Tether& tether, double radius, double wall,
                             const Surroundings& around)
    : around_(around),
      radius_(radius),
      resistance_at_zero_(effective_resistivity(tether, 0) / conductor_area(radius)),
      resistance_per_kelvin_(effective_resistivity(tether, 1) / conductor_area(radius) -
                             resistance_at_zero_),
      diameter_(2 * (radius + wall)),
      surface_share_(pair_surface_share),
      wind_share_(around.inclination ? cigre601_attack_factor(*around.inclination) : 1),
      still_air_share_(hanging_in_still_air),
      density_0C_(density_at_zero(around)) {
  const double around_metal = 2 * pi * insulation_conductivity(tether.insulation);
  thermal_resistance_ = std::log((radius + wall) / radius) / around_metal;
  thermal_resistance_slope_ = -wall / (radius * (radius + wall)) / around_metal;
}

ConductorHeat ConductorHeat::in(const Surroundings& around) const {
  ConductorHeat other = *this;
  other.around_ = around;
  other.wind_share_ = around.inclination ? cigre601_attack_factor(*around.inclination) : 1;
  other.density_0C_ = density_at_zero(around);
  return other;
}

ConductorHeat ConductorHeat::wound(const Surroundings& around, const DrumPackage& package) const {
  ConductorHeat other = in(around);
  other.diameter_ = 2 * package.outer_radius;
  other.diameter_slope_ = 2 * package.outer_radius_slope;
  const double perimeter = pi * other.diameter_;
  other.surface_share_ = package.surface / perimeter;
  other.surface_share_slope_ = package.surface_slope / perimeter -
                               other.surface_share_ * other.diameter_slope_ / other.diameter_;
  other.still_air_share_ = 1;
  other.thermal_resistance_ = package.thermal_resistance;
  other.thermal_resistance_slope_ = package.thermal_resistance_slope;
  return other;
}

ConductorHeat::Flow ConductorHeat::flow(double surface_C) const {
  const double rise = surface_C - around_.temperature_C;
  const double film = 0.5 * (surface_C + around_.temperature_C);
  const AirProperties air = air_properties(film, density_0C_);
  // Of the logarithms of the air's properties, by the surface's temperature.
  const double conductivity_growth = 0.5 * conductivity_of_air.slope(film) / air.conductivity;
  const double thickening = 0.5 * viscosity_of_air.slope(film) / viscosity_of_air.at(film);
  const double viscosity_growth =
      thickening + 0.5 * expansion_of_air / (1 + expansion_of_air * film);
  const double prandtl_growth = thickening - conductivity_growth;

  Nusselt nusselt;
  double by_log_diameter = 0;
  double rise_times_growth = 0;  // of the Nusselt number
  if (around_.wind > 0) {
    nusselt = wind_share_ *
              forced_convection(around_.wind * diameter_ / air.kinematic_viscosity, air.prandtl);
    by_log_diameter = nusselt.by_flow;
    rise_times_growth =
        rise * (nusselt.by_prandtl * prandtl_growth - nusselt.by_flow * viscosity_growth);
  }
  const double hanging = still_air_share_;
  const double rayleigh = around_.gravity * std::max(rise, 0.0) / kelvin(film) * diameter_ *
                          diameter_ * diameter_ /
                          (air.kinematic_viscosity * air.kinematic_viscosity) * air.prandtl;
  // Without the factor below 1 by which the Prandtl number enters, natural convection is more.
  const double needed = std::max(0.0, (std::sqrt(nusselt.value / hanging) - 0.6) / 0.387);
  const double cube = needed * needed * needed;
  if (rayleigh >= cube * cube || around_.inclination) {
    const Nusselt natural =
        around_.inclination ? inclined_convection(rayleigh, air.prandtl, diameter_ / around_.length,
                                                  *around_.inclination)
                            : hanging * natural_convection(rayleigh, air.prandtl);
    if (natural.value > nusselt.value) {
      nusselt.value = natural.value;
      by_log_diameter = 3 * natural.by_flow + natural.by_slenderness;
      const double flow_growth = prandtl_growth - 2 * viscosity_growth - 0.5 / kelvin(film);
      rise_times_growth =
          natural.by_flow * (1 + rise * flow_growth) + natural.by_prandtl * rise * prandtl_growth;
    }
  }
  const double convected = pi * air.conductivity * nusselt.value * rise;
  const double convected_growth =
      pi * air.conductivity *
      (nusselt.value * (1 + rise * conductivity_growth) + rise_times_growth);
  const double radiated =
      radiated_heat(pi * diameter_, emissivity, surface_C, around_.temperature_C);
  const double hot = kelvin(surface_C);
  const double radiated_growth =
      4 * pi * diameter_ * emissivity * stefan_boltzmann * hot * hot * hot;
  const double share = around_.cooling * surface_share_;
  const double with_diameter =
      share * (pi * air.conductivity * rise * by_log_diameter + radiated) / diameter_ -
      absorptivity * around_.sun;
  const double with_share = around_.cooling * surface_share_slope_ * (convected + radiated);
  return {share * (convected + radiated) - absorptivity * around_.sun * diameter_,
          share * (convected_growth + radiated_growth),
          diameter_slope_ * with_diameter + with_share};
}

std::optional<double> ConductorHeat::temperature(double current) const {
  const auto surface = steady_surface(current);
  return surface ? std::optional(surface->steady_inside()) : std::nullopt;
}

ConductorHeat::Balance ConductorHeat::balance(double surface_C, double current) const {
  const Flow out = flow(surface_C);
  // T_c = T_s + q·R_th, where the heat does not flow in from the sun.
  const bool outward = out.heat > 0;
  const double through = outward ? thermal_resistance_ : 0;
  const double per_surface = 1 + out.by_temperature * through;
  const double square = current * current;
  const double inside = surface_C + out.heat * through;
  const double made = square * resistance(inside);
  const double rate = out.by_temperature - square * resistance_per_kelvin_ * per_surface;
  // The balance q = I²·R(T_c)/A and T_c, both differentiated by the radius.
  const double wall_growth = outward ? out.heat * thermal_resistance_slope_ : 0;
  const double inside_growth = out.by_radius * through + wall_growth;
  const double imbalance_growth =
      out.by_radius + 2 * made / radius_ - square * resistance_per_kelvin_ * inside_growth;
  Balance balance;
  balance.surface_C = surface_C;
  balance.inside_C = inside;
  balance.surface_change = (made - out.heat) / rate;
  balance.inside_per_surface = per_surface;
  balance.by_current = current > 0 ? 2 * made / current / rate : 0;
  balance.inside_by_radius = inside_growth - per_surface * imbalance_growth / rate;
  balance.returns = rate > 0;
  return balance;
}

double ConductorHeat::first_surface(double current) const {
  // With Nu = 1 + 0.5·√Re and 6 W/(m²·K) radiated, each within a third at the sizes of a tether.
  const AirProperties air = air_properties(around_.temperature_C, density_0C_);
  const double nusselt = 1 + 0.5 * std::sqrt(around_.wind * diameter_ / air.kinematic_viscosity);
  const double cooled =
      around_.cooling * surface_share_ * (pi * air.conductivity * nusselt + 6 * pi * diameter_);
  const double heat = current * current * resistance(around_.temperature_C) +
                      absorptivity * around_.sun * diameter_;
  return around_.temperature_C + std::min(heat / cooled, 100.0);
}

std::optional<ConductorHeat::Balance> ConductorHeat::steady_surface(double current) const {
  if (!(current > 0)) return search_surface(current);
  double surface = first_surface(current);
  for (int step = 0; step < 15; ++step) {
    const Balance at = balance(surface, current);
    if (!at.returns) break;
    surface += at.surface_change;
    if (!(surface > around_.temperature_C - 1 && surface < highest_conductor_temperature_C)) break;
    if (at.relative_change(around_.temperature_C) <= 1e-6) {
      if (!(at.steady_inside() <= highest_conductor_temperature_C)) return std::nullopt;
      return at;
    }
  }
  return search_surface(current);
}

/// The same step by step, where runaway is near or certain. The heat given off rises ever more
/// steeply with the surface's temperature, the heat made does not: what is made at the highest
/// temperature and not given off was not given off below, either.
std::optional<ConductorHeat::Balance> ConductorHeat::search_surface(double current) const {
  const double square = current * current;
  const auto surplus = [&](double surface) {
    const double heat = given_off(surface);
    return heat - square * resistance(surface + std::max(heat, 0.0) * thermal_resistance_);
  };
  if (surplus(highest_conductor_temperature_C) < 0) return std::nullopt;
  const auto found = first_root(surplus, around_.temperature_C, highest_conductor_temperature_C);
  if (!found) return std::nullopt;
  Balance at = balance(*found, current);
  at.surface_change = 0;
  return at.inside_C <= highest_conductor_temperature_C ? std::optional(at) : std::nullopt;
}

}  // namespace tethercalc
