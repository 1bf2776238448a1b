// Notation: a side of the square that the tether takes, w width between the flanges, i and o inner
// and outer radius of the package.

#include "tethercalc/model/drum_package.hpp"

#include <cmath>
#include <numbers>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

using std::numbers::pi;

/// Side of the square that two wires side by side take of a square pattern, over the radius of one.
constexpr double around_two = 2 * std::numbers::sqrt2;

/// A quantity and its derivative by the conductors' radius.
struct Slope {
  double value = 0;
  double by_radius = 0;
};

Slope operator+(Slope x, Slope y) { return {x.value + y.value, x.by_radius + y.by_radius}; }
Slope operator-(Slope x, Slope y) { return {x.value - y.value, x.by_radius - y.by_radius}; }
Slope operator*(Slope x, Slope y) {
  return {x.value * y.value, x.by_radius * y.value + x.value * y.by_radius};
}
Slope operator/(Slope x, Slope y) {
  return {x.value / y.value, (x.by_radius * y.value - x.value * y.by_radius) / (y.value * y.value)};
}
Slope operator*(double factor, Slope x) { return {factor * x.value, factor * x.by_radius}; }
Slope square_root(Slope x) {
  const double root = std::sqrt(x.value);
  return {root, 0.5 * x.by_radius / root};
}
/// ln(1 + x).
Slope log_of_one_and(Slope x) { return {std::log1p(x.value), x.by_radius / (1 + x.value)}; }

/// W/(m·K) across wires of metal of radius `r` in insulation.
Slope conductivity_across(const Insulation& insulation, Slope r, double wall) {
  constexpr double of_air = 0.026;  // at 25 °C
  constexpr double filled = pi / 4;
  const Slope one{1, 0};
  const Slope outer = r + Slope{wall, 0};
  const Slope metal = (r * r) / (outer * outer);
  // Air over wire, 0 for a bare one.
  const Slope poorer =
      (of_air / insulation_conductivity(insulation)) * ((one - metal) / (one + metal));
  return of_air * ((Slope{1 + filled, 0} + (1 - filled) * poorer) /
                   (Slope{1 - filled, 0} + (1 + filled) * poorer));
}

}  // namespace

double insulation_conductivity(const Insulation& insulation) {
  constexpr double least = 0.17;
  return insulation.thermal_conductivity > 0 ? insulation.thermal_conductivity : least;
}

bool is_package_known(const Drum& drum) { return drum.core_diameter > 0 && drum.width > 0; }

bool is_cooling_known(const Drum& drum) {
  return is_package_known(drum) || drum_derating(drum).has_value();
}

double wound_side(const Tether& tether, double radius, double wall) {
  return around_two * (radius + wall) + strength_member_data(tether.strength_member).diameter +
         tether.cover_width;
}

double widest_wound_radius(const Tether& tether, double wall) {
  const double width = tether.drum.width;
  return width > 0 ? (width - wound_side(tether, 0, wall)) / around_two : infinity;
}

DrumPackage drum_package(const Tether& tether, double radius, double wall, double length) {
  const Drum& drum = tether.drum;
  const Slope r{radius, 1};
  const double inner = 0.5 * drum.core_diameter;
  const Slope side{wound_side(tether, radius, wall), around_two};
  const Slope volume = length * (side * side);
  // One layer of turns side by side, where they do not reach from flange to flange.
  Slope width = (length / pi) * (side / (Slope{2 * inner, 0} + side));
  const Slope room = drum.width > side.value ? Slope{drum.width, 0} : side;
  if (width.value > room.value) width = room;
  const Slope ring = (1 / pi) * (volume / width);  // o² − i²
  const Slope outer = square_root(Slope{inner * inner, 0} + ring);
  const Slope surface = 2 * pi * (outer * width) + 2 * pi * ring;

  const double core = inner * inner;
  const Slope outwards = 0.25 * (ring - core * log_of_one_and((1 / core) * ring));
  const Slope to_faces = 0.125 * (width * width);
  const Slope k = drum.package_conductivity ? Slope{*drum.package_conductivity, 0}
                                            : conductivity_across(tether.insulation, r, wall);
  // Two conductors heat the square.
  const Slope resistance = 2 * ((outwards * to_faces) / ((outwards + to_faces) * k * side * side));

  DrumPackage package;
  package.outer_radius = outer.value;
  package.outer_radius_slope = outer.by_radius;
  package.layers = (outer.value - inner) / side.value;
  package.conductivity = k.value;
  package.surface = surface.value / (2 * length);
  package.surface_slope = surface.by_radius / (2 * length);
  package.thermal_resistance = resistance.value;
  package.thermal_resistance_slope = resistance.by_radius;
  return package;
}

}  // namespace tethercalc
