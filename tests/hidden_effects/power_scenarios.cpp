#include "hidden_effects/power_scenarios.hpp"

#include <cmath>

namespace power_truth {

using namespace tethercalc;

Design spec(const Rig& rig) {
  // Data sheet of the Holybro AIR2216 920 KV with a 10 inch propeller at 16 V: g, g/W.
  const double sheet[15][2] = {{210, 9.12}, {259, 8.67},  {309, 8.45},  {373, 8.15},  {447, 7.76},
                               {536, 7.39}, {628, 7.01},  {729, 6.73},  {814, 6.44},  {906, 6.18},
                               {993, 5.88}, {1087, 5.65}, {1191, 5.43}, {1289, 5.18}, {1332, 5.13}};
  std::vector<MotorPoint> points;
  for (const auto& row : sheet) {
    points.push_back(
        {rig.motor_size * row[0] * unit::gram_force, rig.motor_size * row[0] / row[1]});
  }
  Design design;
  design.drone.mass = rig.mass;
  design.drone.motor_count = 4;
  design.drone.motor = MotorCurve(points);
  design.drone.auxiliary_power = rig.auxiliaries;
  design.drone.drag = {0.01451 * rig.drag_scale, 0.01361 * rig.drag_scale, 19.27, 0};
  design.tether.length = rig.length;
  design.tether.cross_section = rig.area;
  design.tether.conductor = {0.0278e-6, 0.00403, 2700};
  design.tether.insulation = {1360, 0.75e-3};
  if (rig.cable != Rig::Cable::straight) {
    design.tether.model = TetherModel::solved;
    design.tether.slack = rig.slack;
    design.tether.winch_pull = rig.winch_pull;
  }
  design.supply.voltage = rig.voltage;
  design.supply.converter = {{{0.0, rig.efficiency}}, 20};
  design.flight.airspeed = 8.3333;
  design.flight.air_density = rig.air_density;
  return design;
}

PowerLog as_power_log(const Log& log) {
  return {log.time,           log.height,         log.airspeed,      log.ambient_temperature,
          log.supply_voltage, log.supply_current, log.drone_voltage, log.bus_voltage,
          log.bus_current};
}

const std::vector<HiddenEffect>& hidden_effects() {
  // A strength s runs geometrically from the first to the second number.
  static const auto between = [](double low, double high, double s) {
    return low * std::pow(high / low, s);
  };
  static const std::vector<HiddenEffect> effects{
      {"current_sensor_gain",
       [](HiddenEffects& h, double s) { h.supply_current_gain = 1 + between(0.004, 0.06, s); },
       [](const HiddenEffects& h) { return h.supply_current_gain; }},
      {"conductor_resistivity",
       [](HiddenEffects& h, double s) { h.resistivity_factor = 1 + between(0.01, 0.3, s); },
       [](const HiddenEffects& h) { return h.resistivity_factor; }},
      {"conductor_heating",
       [](HiddenEffects& h, double s) {
         h.heating = between(5, 30, s);
         h.heating_time_constant = 120 + 180 * s;
       },
       [](const HiddenEffects& h) { return h.heating; }},
      {"contact_resistance",
       [](HiddenEffects& h, double s) { h.contact_resistance = between(0.01, 0.6, s); },
       [](const HiddenEffects& h) { return h.contact_resistance; }},
      {"spooled_length", [](HiddenEffects& h, double s) { h.spooled_length = between(3, 40, s); },
       [](const HiddenEffects& h) { return h.spooled_length; }},
      {"converter_efficiency_curve",
       [](HiddenEffects& h, double s) { h.converter_fixed_loss = between(8, 30, s); },
       [](const HiddenEffects& h) { return h.converter_fixed_loss; }},
      {"auxiliary_power",
       [](HiddenEffects& h, double s) { h.auxiliary_power = between(0.8, 25, s); },
       [](const HiddenEffects& h) { return h.auxiliary_power; }},
      {"motor_power_scale",
       [](HiddenEffects& h, double s) { h.motor_power_factor = 1 + between(0.01, 0.15, s); },
       [](const HiddenEffects& h) { return h.motor_power_factor; }},
      {"translational_lift",
       [](HiddenEffects& h, double s) { h.translational_lift = between(0.03, 0.3, s); },
       [](const HiddenEffects& h) { return h.translational_lift; }},
      {"extra_mass", [](HiddenEffects& h, double s) { h.extra_mass = between(0.02, 0.4, s); },
       [](const HiddenEffects& h) { return h.extra_mass; }},
      {"tether_drag",
       [](HiddenEffects& h, double s) { h.tether_drag_factor = 1 + between(0.15, 1.5, s); },
       [](const HiddenEffects& h) { return h.tether_drag_factor; }},
      {"airframe_drag",
       [](HiddenEffects& h, double s) { h.airframe_drag_factor = 1 + between(0.25, 2, s); },
       [](const HiddenEffects& h) { return h.airframe_drag_factor; }},
      {"current_offset",
       [](HiddenEffects& h, double s) { h.supply_current_offset = between(0.01, 0.2, s); },
       [](const HiddenEffects& h) { return h.supply_current_offset; }},
      {"supply_voltage_gain",
       [](HiddenEffects& h, double s) { h.supply_voltage_gain = 1 - between(0.001, 0.02, s); },
       [](const HiddenEffects& h) { return h.supply_voltage_gain; }},
      {"drone_voltage_offset",
       [](HiddenEffects& h, double s) { h.drone_voltage_offset = between(0.05, 1.5, s); },
       [](const HiddenEffects& h) { return h.drone_voltage_offset; }},
      {"bus_current_gain",
       [](HiddenEffects& h, double s) { h.bus_current_gain = 1 - between(0.005, 0.08, s); },
       [](const HiddenEffects& h) { return h.bus_current_gain; }},
      {"height_bias", [](HiddenEffects& h, double s) { h.height_bias = between(0.3, 4, s); },
       [](const HiddenEffects& h) { return h.height_bias; }},
      {"airspeed_scale",
       [](HiddenEffects& h, double s) { h.airspeed_gain = 1 - between(0.1, 0.35, s); },
       [](const HiddenEffects& h) { return h.airspeed_gain; }},
      {"tether_sag", [](HiddenEffects& h, double s) { h.slack = between(0.02, 0.3, s); },
       [](const HiddenEffects& h) { return h.slack; }},
      {"motor_ageing",
       [](HiddenEffects& h, double s) { h.motor_power_growth = between(0.02, 0.2, s); },
       [](const HiddenEffects& h) { return h.motor_power_growth; }},
      {"air_density",
       [](HiddenEffects& h, double s) { h.air_density_factor = 1 - between(0.04, 0.25, s); },
       [](const HiddenEffects& h) { return h.air_density_factor; }},
      {"payload_drop", [](HiddenEffects& h, double s) { h.payload_drop = between(0.04, 0.4, s); },
       [](const HiddenEffects& h) { return h.payload_drop; }},
      {"winch_tension", [](HiddenEffects& h, double s) { h.winch_pull = between(0.2, 4, s); },
       [](const HiddenEffects& h) { return h.winch_pull; }},
      {"cable_temperature",
       [](HiddenEffects& h, double s) {
         h.air_share = 1;
         h.colder_air = between(4, 30, s);
       },
       [](const HiddenEffects& h) { return h.air_share; }},
      {"climb_power", [](HiddenEffects& h, double s) { h.climb_work = between(0.3, 1.5, s); },
       [](const HiddenEffects& h) { return h.climb_work; }},
  };
  return effects;
}

const std::vector<UnknownEffect>& unknown_effects() {
  static const std::vector<UnknownEffect> unknowns{
      {"step of the motor power", "time_s",
       [](HiddenEffects& h, double s) { h.step_in_motor_power = 0.03 + 0.07 * s; }},
      {"step of a resistance", "time_s",
       [](HiddenEffects& h, double s) { h.step_in_resistance = 0.03 + 0.15 * s; }},
      {"motor power with height²", "height_m",
       [](HiddenEffects& h, double s) { h.motor_power_per_height = 0.06 + 0.1 * s; }},
      {"wave of the motor power", "time_s",
       [](HiddenEffects& h, double s) { h.motor_power_swing = 0.02 + 0.06 * s; }}};
  return unknowns;
}

}  // namespace power_truth
