#include "tethercalc/model/tether.hpp"

#include <cmath>
#include <numbers>

namespace tethercalc {

double resistivity(const Tether& tether) {
  const Conductor& c = tether.conductor;
  return c.resistivity_20C *
         (1 + c.temperature_coefficient * (tether.conductor_temperature_C - 20));
}

double conductor_radius(double area) { return std::sqrt(area / std::numbers::pi); }

double loop_resistance(const Tether& tether, double area) {
  return 2 * (tether.length + tether.spooled_length) * resistivity(tether) / area +
         tether.contact_resistance;
}

double airborne_mass(const Tether& tether, double area) {
  const double wall = tether.insulation.thickness;
  const double insulation_area =
      std::numbers::pi * wall * (2 * conductor_radius(area) + wall);  // π((r+s)² − r²)
  return 2 * tether.length *
         (tether.conductor.density * area + tether.insulation.density * insulation_area);
}

double tether_drag_area(const Tether& tether, double area) {
  return tether.drag_coefficient * tether.projection_factor * 4 * tether.length *
         (conductor_radius(area) + tether.insulation.thickness);
}

}  // namespace tethercalc
