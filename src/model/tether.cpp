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

double effective_resistivity(const Tether& tether, double temperature_C) {
  return tether.stranding_factor * resistivity(tether.conductor, temperature_C);
}

bool is_heated(const Tether& tether) {
  return tether.ambient_temperature_C.has_value() || tether.heating.rise_per_loss > 0;
}

bool hangs_on_winch(const Tether& tether) {
  return tether.model == TetherModel::solved && tether.winch_pull > 0;
}

Tether without_heat(Tether tether) {
  tether.conductor_temperature_C =
      tether.ambient_temperature_C.value_or(tether.conductor_temperature_C);
  tether.ambient_temperature_C.reset();
  tether.heating.rise_per_loss = 0;
  return tether;
}

double settled_rise(const Tether& tether, double area, double current, double airspeed) {
  const MeasuredHeating& heating = tether.heating;
  const double loss = current * current * 2 * effective_resistivity(tether, 20) / area;
  return heating.rise_per_loss * loss / (1 + heating.wind_cooling * std::sqrt(std::abs(airspeed)));
}

double insulation_wall(const Insulation& insulation, double voltage) {
  if (!(insulation.breakdown_strength > 0)) return insulation.thickness;
  return std::max(insulation.thickness,
                  insulation.dielectric_safety_factor * voltage / insulation.breakdown_strength);
}

double breakdown_voltage(const Insulation& insulation, double voltage) {
  return insulation.breakdown_strength * insulation_wall(insulation, voltage);
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

double vibrating_drag_coefficient(const Tether& tether) {
  return tether.drag_coefficient * (1 + 2.1 * tether.vibration_amplitude);
}

double conductor_radius(double area) { return std::sqrt(area / std::numbers::pi); }

double conductor_area(double radius) { return std::numbers::pi * radius * radius; }

double breaking_load(const Tether& tether, double area) {
  const double member = strength_member_data(tether.strength_member).strength;
  return member > 0 ? member : 2 * area * tether.conductor.tensile_strength;
}

}  // namespace tethercalc
