#include "diagnose/power_effects.hpp"

#include "diagnose/power_chain.hpp"

namespace tethercalc {
namespace {

using Values = std::span<const double>;

const std::string to_separate_tether =
    "Fly at several heights: contacts and a drum add the same resistance at every height, a higher "
    "resistivity adds in proportion to the height.";
const std::string to_separate_converter =
    "Vary the load, by height, payload or airspeed: auxiliaries draw the same at every load, the "
    "converter's losses grow with it.";
const std::string to_separate_motors =
    "Fly at several heights and airspeeds, and weigh the drone: mass and motor efficiency differ "
    "only in how the power bends with the thrust.";
const std::string to_separate_airspeed =
    "Hold airspeeds between 0 and the design airspeed at a low and at a great height: tether drag "
    "grows with the height, airframe drag does not, and the induced power falls before drag rises.";

Effect conductor_resistivity() {
  Effect e;
  e.id = "conductor_resistivity";
  e.title = "The conductor resists more than its material should";
  e.mechanism =
      "Alloy, stranding or damage make the resistivity another than the spec's, so the voltage "
      "lost "
      "grows in proportion to deployed length and current.";
  e.stage = Stage::tether;
  e.parameters = {{"resistivity_factor", "1", 1, 1, 0.3, 5, 0.1, "tether.conductor"}};
  e.needs = {"drone_voltage_V"};
  e.to_separate = to_separate_tether;
  e.change = "R = f·2hρ/A";
  e.channel = "current_height";
  e.on_power = [](PowerModel& m, Values x) { m.design.tether.conductor.resistivity_20C *= x[0]; };
  return e;
}

Effect conductor_heating() {
  Effect e;
  e.id = "conductor_heating";
  e.title = "The current heats the conductor";
  e.mechanism =
      "The cable warms above ambient by its own I²R, within minutes and less in the wind, and its "
      "resistance rises with the temperature.";
  e.stage = Stage::tether;
  e.parameters = {{"heating_K_m_per_W", "K·m/W", 1, 0, 0, 200, 5, "tether.heating.rise_K_m_per_W",
                   [](const Design& d) { return d.tether.heating.rise_per_loss; }},
                  {"time_constant_s", "s", 1, 200, 5, 3000, 100, "tether.heating.time_constant_s",
                   [](const Design& d) { return d.tether.heating.time_constant; }},
                  {"wind_cooling_sqrt_s_per_m", "(s/m)^0.5", 1, 0, 0, 3, 0.2,
                   "tether.heating.wind_cooling_sqrt_s_per_m",
                   [](const Design& d) { return d.tether.heating.wind_cooling; }}};
  e.needs = {"drone_voltage_V"};
  e.to_separate =
      "Hover at one height for ten minutes from a cold start: heating shows as a drift of the "
      "resistance, everything else does not.";
  e.change = "R = 2hρ(T)/A, τ·dT/dt = T_ambient + k·I²R′/(1 + c·√v) − T";
  e.channel = "time";
  e.on_power = [](PowerModel& m, Values x) { m.design.tether.heating = {x[0], x[1], x[2]}; };
  return e;
}

Effect contact_resistance() {
  Effect e;
  e.id = "contact_resistance";
  e.title = "Plugs or slip rings add resistance";
  e.mechanism = "Contacts lose a voltage in proportion to the current, the same at every height.";
  e.stage = Stage::tether;
  e.parameters = {
      {"contact_resistance_ohm", "ohm", 1, 0, 0, 50, 0.1, "tether.contact_resistance_ohm"}};
  e.needs = {"drone_voltage_V"};
  e.to_separate = to_separate_tether;
  e.change = "R = 2hρ/A + R_c";
  e.channel = "supply_current";
  e.on_power = [](PowerModel& m, Values x) { m.design.tether.contact_resistance += x[0]; };
  return e;
}

Effect spooled_length() {
  Effect e;
  e.id = "spooled_length";
  e.title = "Cable on the drum carries the current too";
  e.mechanism =
      "The whole cable is in the circuit at every height: what is not in the air is on the drum, "
      "with resistance but without airborne mass.";
  e.stage = Stage::tether;
  e.parameters = {{"spooled_length_m", "m", 1, 0, 0, 1000, 10, "tether.spooled_length_m"}};
  e.needs = {"drone_voltage_V"};
  e.to_separate = to_separate_tether;
  e.change = "R = 2(L + s)ρ/A at every height, L the design length";
  e.channel = "supply_current";
  e.on_power = [](PowerModel& m, Values x) { m.design.tether.spooled_length += x[0]; };
  return e;
}

Effect converter_efficiency_curve() {
  Effect e;
  e.id = "converter_efficiency_curve";
  e.title = "The converter's efficiency depends on its load";
  e.mechanism =
      "A converter loses a fixed power and one that grows with the square of its output, so it is "
      "best at one load and worse below and above.";
  e.stage = Stage::converter;
  e.sizes = 2;
  e.parameters = {
      {"fixed_loss_W", "W", 1, 0, 0, 1000, 5, "supply.converter.losses.fixed_W",
       [](const Design& d) { return d.supply.converter.losses.fixed; }},
      {"square_loss_per_W", "1/W", 1, 0, 0, 0.02, 1e-5, "supply.converter.losses.square_per_W",
       [](const Design& d) { return d.supply.converter.losses.square; }}};
  e.needs = {"drone_voltage_V", "bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_converter;
  e.change = "P_in = P_out + P_0 + c·P_out²";
  e.channel = "bus_power";
  e.on_power = [](PowerModel& m, Values x) { m.design.supply.converter.losses = {x[0], x[1]}; };
  return e;
}

Effect auxiliary_power() {
  Effect e;
  e.id = "auxiliary_power";
  e.title = "Payload and electronics draw another power";
  e.mechanism =
      "Flight controller and payload draw a constant power at the converter's input that differs "
      "from the spec's.";
  e.stage = Stage::converter;
  e.parameters = {{"extra_auxiliary_power_W", "W", 1, 0, -200, 500, 2, "drone.auxiliary_power_W"}};
  e.needs = {"drone_voltage_V", "bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_converter;
  e.change = "P_aux + ΔP";
  e.channel = "bus_power";
  e.on_power = [](PowerModel& m, Values x) { m.design.drone.auxiliary_power += x[0]; };
  return e;
}

Effect extra_mass() {
  Effect e;
  e.id = "extra_mass";
  e.title = "The drone is heavier than the spec says";
  e.mechanism = "More weight needs more thrust at every height and airspeed.";
  e.stage = Stage::airframe;
  e.parameters = {{"extra_mass_kg", "kg", 1, 0, -0.5, 5, 0.05, "drone.mass_g"}};
  e.needs = {"bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_motors;
  e.change = "m_d + Δm";
  e.channel = "height";
  e.on_power = [](PowerModel& m, Values x) { m.design.drone.mass += x[0]; };
  return e;
}

Effect motor_power_scale() {
  Effect e;
  e.id = "motor_power_scale";
  e.title = "The motors need more power than their data sheet says";
  e.mechanism =
      "Worn bearings, other propellers or thin air scale the power for every thrust by one factor.";
  e.stage = Stage::motors;
  e.parameters = {{"motor_power_factor", "1", 1, 1, 0.3, 4, 0.05, "drone.motor_power_factor"}};
  e.needs = {"bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_motors;
  e.change = "f·P_motor(T)";
  e.channel = "height";
  e.on_power = [](PowerModel& m, Values x) { m.design.drone.motor_power_factor *= x[0]; };
  return e;
}

Effect translational_lift() {
  Effect e;
  e.id = "translational_lift";
  e.title = "Moving through the air saves hover power";
  e.mechanism =
      "In forward flight the rotors take in more air, so the induced part of the power falls with "
      "airspeed.";
  e.stage = Stage::motors;
  e.parameters = {
      {"induced_share", "1", 1, 0, 0, 0.95, 0.05, "drone.translational_lift.induced_share",
       [](const Design& d) { return d.drone.translational_lift.induced_share; }},
      {"hover_induced_speed_m_s", "m/s", 1, 6, 3, 10, 2,
       "drone.translational_lift.hover_induced_speed_m_s",
       [](const Design& d) { return d.drone.translational_lift.hover_induced_speed; }}};
  e.needs = {"bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_airspeed;
  e.change = "P·(1 − s·(1 − ν(v/v_h))), ν√((v/v_h)² + ν²) = 1";
  e.channel = "airspeed";
  e.on_power = [](PowerModel& m, Values x) { m.design.drone.translational_lift = {x[0], x[1]}; };
  return e;
}

Effect tether_drag() {
  Effect e;
  e.id = "tether_drag";
  e.title = "The tether drags more, or less, than assumed";
  e.mechanism =
      "The wind's force on the cable grows with deployed length and the square of the airspeed, "
      "and "
      "the drone tilts against it.";
  e.stage = Stage::airframe;
  e.parameters = {{"tether_drag_factor", "1", 1, 1, 0, 10, 0.2, "tether.drag_coefficient"}};
  e.needs = {"bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_airspeed;
  e.change = "f·C";
  e.channel = "airspeed";
  e.on_power = [](PowerModel& m, Values x) { m.design.tether.drag_coefficient *= x[0]; };
  return e;
}

Effect airframe_drag() {
  Effect e;
  e.id = "airframe_drag";
  e.title = "The drone drags more, or less, than assumed";
  e.mechanism =
      "Payload or landing gear scale the drag of the drone, which it tilts against at every "
      "height.";
  e.stage = Stage::airframe;
  e.parameters = {{"airframe_drag_factor", "1", 1, 1, 0, 10, 0.2, "drone.drag"}};
  e.needs = {"bus_voltage_V", "bus_current_A"};
  e.to_separate = to_separate_airspeed;
  e.change = "f·A_f, f·A_t";
  e.channel = "airspeed";
  e.on_power = [](PowerModel& m, Values x) {
    m.design.drone.drag.front_area *= x[0];
    m.design.drone.drag.top_area *= x[0];
  };
  return e;
}

Effect current_sensor_gain() {
  Effect e;
  e.id = "current_sensor_gain";
  e.title = "The ground ammeter reads wrong";
  e.mechanism =
      "The supply current is read too high or too low by one factor, in the tether's loss and at "
      "the converter alike.";
  e.stage = Stage::supply;
  e.parameters = {{"supply_current_gain", "1", 1, 1, 0.5, 2, 0.03, ""}};
  e.needs = {"drone_voltage_V", "bus_voltage_V", "bus_current_A"};
  e.to_separate = "Compare the ammeter with another one.";
  e.change = "I = I_read/g";
  e.channel = "supply_current";
  e.on_power = [](PowerModel& m, Values x) { m.supply_current_gain *= x[0]; };
  return e;
}

}  // namespace

std::vector<Effect> power_effects() {
  std::vector<Effect> effects{
      current_sensor_gain(), conductor_resistivity(), conductor_heating(),
      contact_resistance(),  spooled_length(),        converter_efficiency_curve(),
      auxiliary_power(),     motor_power_scale(),     translational_lift(),
      extra_mass(),          tether_drag(),           airframe_drag()};
  for (Effect& effect : effects) effect.log = LogKind::power;
  return effects;
}

}  // namespace tethercalc
