// Notation: T temperature in °C, c conductor, s surface, a air, f film (mean of s and a); q heat in
// W/m; Nu, Re, Pr, Ra Nusselt, Reynolds, Prandtl, Rayleigh number.

#include "tethercalc/model/conductor_heat.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

using std::numbers::pi;

/// W/(m²·K⁴), CODATA 2018 (exact since the SI of 2019).
constexpr double stefan_boltzmann = 5.670374419e-8;

constexpr double emissivity = 0.9;    // CIGRE TB 601: 0.8 to 0.9 for weathered surfaces
constexpr double absorptivity = 0.9;  // likewise
constexpr double least_conductivity = 0.17;
constexpr double pair_surface_share = (pi + 2) / (2 * pi);
constexpr double steepest_known_inclination = pi / 3;

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

}  // namespace

AirProperties air_properties(double film_temperature_C, double density_at_0C) {
  const double t = film_temperature_C;
  const double conductivity = 2.368e-2 + 7.23e-5 * t - 2.763e-8 * t * t;
  const double viscosity = 17.239e-6 + 4.635e-8 * t - 2.03e-11 * t * t;
  const double density = density_at_0C / (1 + 0.00367 * t);
  return {conductivity, viscosity / density, 1005 * viscosity / conductivity};
}

double churchill_bernstein(double reynolds, double prandtl) {
  return 0.3 + 0.62 * std::sqrt(reynolds) * std::cbrt(prandtl) /
                   std::pow(1 + std::pow(0.4 / prandtl, 2.0 / 3), 0.25) *
                   std::pow(1 + std::pow(reynolds / 282000, 0.625), 0.8);
}

double churchill_chu(double rayleigh, double prandtl) {
  const double root = 0.6 + 0.387 * std::pow(rayleigh, 1.0 / 6) /
                                std::pow(1 + std::pow(0.559 / prandtl, 9.0 / 16), 8.0 / 27);
  return root * root;
}

double cigre601_stranded(double reynolds, double roughness) {
  if (reynolds < 2650) return 0.641 * std::pow(reynolds, 0.471);
  return roughness <= 0.05 ? 0.178 * std::pow(reynolds, 0.633) : 0.048 * std::pow(reynolds, 0.8);
}

double cigre601_attack_factor(double attack_angle) {
  const double sine = std::sin(attack_angle);
  return attack_angle <= 24 * unit::degree ? 0.42 + 0.68 * std::pow(sine, 1.08)
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

double ampacity(double heat, double resistance) { return std::sqrt(heat / resistance); }

ConductorHeat::ConductorHeat(const Tether& tether, double radius, double wall,
                             const Surroundings& around)
    : conductor_(tether.conductor),
      around_(around),
      area_(conductor_area(radius)),
      diameter_(2 * (radius + wall)),
      density_0C_(around.air_density * (1 + 0.00367 * around.temperature_C)) {
  const double known = tether.insulation.thermal_conductivity;
  thermal_resistance_ =
      std::log((radius + wall) / radius) / (2 * pi * (known > 0 ? known : least_conductivity));
}

double ConductorHeat::resistance(double temperature_C) const {
  return resistivity(conductor_, temperature_C) / area_;
}

double ConductorHeat::given_off(double surface_C) const {
  const double rise = surface_C - around_.temperature_C;
  const double film = 0.5 * (surface_C + around_.temperature_C);
  const AirProperties air = air_properties(film, density_0C_);
  static const double hanging = cigre601_inclination_factor(steepest_known_inclination);
  const double rayleigh = around_.gravity * std::max(rise, 0.0) / kelvin(film) * diameter_ *
                          diameter_ * diameter_ /
                          (air.kinematic_viscosity * air.kinematic_viscosity) * air.prandtl;
  double nusselt = 0;
  if (around_.wind > 0) {
    const double reynolds = around_.wind * diameter_ / air.kinematic_viscosity;
    nusselt = churchill_bernstein(reynolds, air.prandtl);
  }
  // Without the factor below 1 by which the Prandtl number enters, natural convection is more.
  const double root = 0.6 + 0.387 * std::cbrt(std::sqrt(rayleigh));
  if (nusselt < hanging * root * root) {
    nusselt = std::max(nusselt, hanging * churchill_chu(rayleigh, air.prandtl));
  }
  const double convected = pi * air.conductivity * nusselt * rise;
  const double radiated =
      radiated_heat(pi * diameter_, emissivity, surface_C, around_.temperature_C);
  return around_.cooling * pair_surface_share * (convected + radiated) -
         absorptivity * around_.sun * diameter_;
}

std::optional<double> ConductorHeat::temperature(double current) const {
  const auto surface = steady_surface(current, cold_surface());
  return surface ? std::optional(surface->inside_C) : std::nullopt;
}

ConductorHeat::Surface ConductorHeat::cold_surface() const {
  // A surface as warm as the air gives nothing off but what it takes from the sun.
  const double from_sun = absorptivity * around_.sun * diameter_;
  constexpr double rise = 20;
  Surface surface;
  surface.temperature_C = around_.temperature_C + rise;
  surface.heat = given_off(surface.temperature_C);
  surface.heat_slope = (surface.heat + from_sun) / rise;
  return surface;
}

ConductorHeat::Surface ConductorHeat::surface_like(const Surface& other) const {
  Surface surface = other;
  surface.heat = given_off(surface.temperature_C);
  return surface;
}

/// With what follows from the surface's temperature and heat at `current`.
ConductorHeat::Surface ConductorHeat::balanced(Surface surface, double current) const {
  surface.inside_C = surface.temperature_C + std::max(surface.heat, 0.0) * thermal_resistance_;
  // Along q(T_s) = I²·R(T_c) with T_c = T_s + q·R_th, differentiated by I.
  const double per_kelvin = surface.heat_slope * (surface.heat > 0 ? thermal_resistance_ : 0) + 1;
  const double slope = resistance(1) - resistance(0);
  surface.warming = 2 * current * resistance(surface.inside_C) * per_kelvin /
                    (surface.heat_slope - current * current * slope * per_kelvin);
  return surface;
}

std::optional<ConductorHeat::Surface> ConductorHeat::steady_surface(double current,
                                                                    const Surface& near) const {
  // The heat given off is nearly a line over the surface's temperature; the heat made is one. So
  // the next surface is where the lines meet, the former through the last two surfaces.
  const double square = current * current;
  const double at_zero = resistance(0);
  const double slope = resistance(1) - at_zero;
  Surface at = near;
  for (int step = 0; step < 15; ++step) {
    // q₀ + q'·(T − T₀) = I²·(a + b·(T + q·R_th)), where q > 0; the sun's heat stays outside.
    const double share = at.heat > 0 ? 1 - square * slope * thermal_resistance_ : 1;
    const double rate = at.heat_slope * share - square * slope;
    if (!(rate > 0)) break;
    const double change = (square * (at_zero + slope * at.temperature_C) - at.heat * share) / rate;
    const double rise = at.temperature_C - around_.temperature_C;
    // Beyond that the line through the last two is as good as the balance to 1e-12.
    if (std::abs(change) <= 1e-6 * std::abs(rise) + 1e-11) {
      at.temperature_C += change;
      at.heat += at.heat_slope * change;
      at = balanced(at, current);
      if (!(at.inside_C <= highest_conductor_temperature_C)) return std::nullopt;
      return at;
    }
    const double next = at.temperature_C + change;
    if (!(next > around_.temperature_C - 1 && next < highest_conductor_temperature_C)) break;
    const double heat = given_off(next);
    at.heat_slope = (heat - at.heat) / change;
    at.temperature_C = next;
    at.heat = heat;
  }
  return search_surface(current);
}

/// The same step by step, where runaway is near or certain. The heat given off rises ever more
/// steeply with the surface's temperature, the heat made does not: what is made at the highest
/// temperature and not given off was not given off below, either.
std::optional<ConductorHeat::Surface> ConductorHeat::search_surface(double current) const {
  const double square = current * current;
  const auto surplus = [&](double surface) {
    const double heat = given_off(surface);
    return heat - square * resistance(surface + std::max(heat, 0.0) * thermal_resistance_);
  };
  if (surplus(highest_conductor_temperature_C) < 0) return std::nullopt;
  const auto found = first_root(surplus, around_.temperature_C, highest_conductor_temperature_C);
  if (!found) return std::nullopt;
  constexpr double step = 1e-3;
  Surface surface;
  surface.temperature_C = *found;
  surface.heat = given_off(*found);
  surface.heat_slope = (given_off(*found + step) - surface.heat) / step;
  surface = balanced(surface, current);
  return surface.inside_C <= highest_conductor_temperature_C ? std::optional(surface)
                                                             : std::nullopt;
}

double ConductorHeat::current_at(double temperature_C) const {
  // The surface below a conductor of this temperature: q rises with T_s, and T_s + q·R_th with it.
  const auto excess = [&](double surface) {
    return surface + std::max(given_off(surface), 0.0) * thermal_resistance_ - temperature_C;
  };
  const auto surface = first_root(excess, around_.temperature_C, temperature_C);
  if (!surface) return 0;
  const double heat = given_off(*surface);
  return heat > 0 ? ampacity(heat, resistance(temperature_C)) : 0;
}

}  // namespace tethercalc
