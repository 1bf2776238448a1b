#include "tethercalc/model/tether.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tethercalc {

double resistivity(const Conductor& conductor, double temperature_C) {
  return conductor.resistivity_20C * (1 + conductor.temperature_coefficient * (temperature_C - 20));
}

double resistivity(const Tether& tether) {
  return resistivity(tether.conductor, tether.conductor_temperature_C);
}

double insulation_wall(const Insulation& insulation, double voltage) {
  if (!(insulation.breakdown_strength > 0)) return insulation.thickness;
  return std::max(insulation.thickness,
                  insulation.dielectric_safety_factor * voltage / insulation.breakdown_strength);
}

std::optional<double> drum_derating(const Drum& drum) {
  constexpr std::array by_layers{0.85, 0.65, 0.45, 0.35};
  if (drum.derating) return drum.derating;
  const auto index = static_cast<std::size_t>(drum.layers) - 1;  // wraps for 0
  return index < by_layers.size() ? std::optional(by_layers[index]) : std::nullopt;
}

StrengthMemberData strength_member_data(const StrengthMember& member) {
  if (member.material == StrengthMaterial::none) return {};
  constexpr double fibre_share = 0.72;
  const bool aramid = member.material == StrengthMaterial::aramid;
  const double density = aramid ? 1450 : 990;
  const double tensile_strength = aramid ? 2740e6 : 3090e6;
  return {density * member.cross_section, 2 * conductor_radius(member.cross_section / fibre_share),
          tensile_strength * member.cross_section};
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
             (tether.conductor.density * area + tether.insulation.density * insulation_area) +
         tether.length * strength_member_data(tether.strength_member).mass_per_metre;
}

double tether_drag_area(const Tether& tether, double area) {
  const double member = strength_member_data(tether.strength_member).diameter;
  return tether.drag_coefficient * tether.projection_factor * tether.length *
         (4 * (conductor_radius(area) + tether.insulation.thickness) + member);
}

double breaking_load(const Tether& tether, double area) {
  const double member = strength_member_data(tether.strength_member).strength;
  return member > 0 ? member : 2 * area * tether.conductor.tensile_strength;
}

}  // namespace tethercalc
