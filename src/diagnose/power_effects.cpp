#include "diagnose/power_chain.hpp"

#include <algorithm>
#include <cmath>

#include "diagnose/power_screening.hpp"
#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

using Values = std::span<const double>;

const std::string to_separate_tether =
    "Fly at several heights: contacts and a drum add the same resistance at every height, a higher "
    "resistivity adds in proportion to the height";
const std::string to_separate_converter =
    "Vary the load, by height, payload or airspeed: auxiliaries draw the same at every load, the "
    "converter's losses grow with it";
const std::string to_separate_motors =
    "Weigh the drone, or fly passes at speed with attitude and power logged in one flight: a "
    "heavier "
    "drone leans less. Else fly at several heights and airspeeds: mass and motor efficiency differ "
    "only in how the power bends with the thrust";
const std::string to_separate_airspeed =
    "Hold airspeeds between 0 and the design airspeed at a low and at a great height: tether drag "
    "grows with the height, airframe drag does not, and the induced power falls before drag rises";

const std::string to_separate_meters =
    "Compare the meters at both ends of the tether with one that is trusted, at two currents: what "
    "an instrument adds is there without a load, too";
const std::string to_separate_lengths =
    "Measure the cable that is out, and compare the height with a tape or another altimeter: a "
    "wrong height is the same at every height, slack grows with it";

/// Where an effect shows that does not say it.
std::vector<Stage> shown_by(Stage stage) {
  if (stage == Stage::supply) return {Stage::tether, Stage::converter};
  if (stage == Stage::airframe) return {Stage::motors, Stage::airframe};
  return {stage};
}

}  // namespace

std::vector<Effect> power_effects() {
  std::vector<Effect> effects{
      {.id = "current_sensor_gain",
       .title = "The ground ammeter reads wrong",
       .mechanism = "The supply current is read too high or too low by one factor, "
                    "in the tether's loss and at the converter alike.",
       .stage = Stage::supply,
       .parameters = {{"supply_current_gain", "1", 1, 1, 0.5, 2, 0.03, ""}},
       .to_separate = "Compare the ammeter with another one",
       .change = "I = I_read/g",
       .channel = "supply_current",
       .on_power = [](PowerModel& m, Values x) { m.instruments.supply_current_gain *= x[0]; }},

      {.id = "current_offset",
       .title = "The ground ammeter is off zero",
       .mechanism = "The same current is added to every reading, so its share is largest at a "
                    "light load.",
       .stage = Stage::supply,
       .parameters = {{"supply_current_offset_A", "A", 1, 0, -5, 5, 0.05}},
       .to_separate = to_separate_meters,
       .change = "I = I_read − I_0",
       .channel = "supply_current",
       .on_power = [](PowerModel& m, Values x) { m.instruments.supply_current_offset += x[0]; }},

      {.id = "supply_voltage_gain",
       .title = "The voltmeter at the ground reads wrong",
       .mechanism = "The supply voltage is read too high or too low by one factor, so the tether "
                    "seems to lose a voltage even without a current.",
       .stage = Stage::supply,
       .parameters = {{"supply_voltage_gain", "1", 1, 1, 0.8, 1.25, 0.002}},
       .to_separate = to_separate_meters,
       .change = "U = U_read/g",
       .channel = "time",
       .on_power = [](PowerModel& m, Values x) { m.instruments.supply_voltage_gain *= x[0]; },
       .shows_in = {Stage::tether}},

      {.id = "conductor_resistivity",
       .title = "The conductor resists more, or less, than its material should",
       .mechanism = "Alloy, stranding or damage make the resistivity another than the spec's, so "
                    "the voltage lost grows in proportion to deployed length and current.",
       .stage = Stage::tether,
       .parameters = {{"resistivity_factor", "1", 1, 1, 0.3, 5, 0.1, "tether.conductor"}},
       .to_separate = to_separate_tether,
       .change = "R = f·2hρ/A",
       .channel = "current_height",
       .on_power = [](PowerModel& m,
                      Values x) { m.design.tether.conductor.resistivity_20C *= x[0]; }},

      {.id = "conductor_heating",
       .title = "The current heats the conductor",
       .mechanism = "The cable warms above ambient by its own I²R, within minutes and less in the "
                    "wind, and its resistance rises with the temperature.",
       .stage = Stage::tether,
       .parameters = {{"heating_K_m_per_W", "K·m/W", 1, 0, 0, 200, 5,
                       "tether.heating.rise_K_m_per_W",
                       [](const Design& d) { return d.tether.heating.rise_per_loss; }},
                      {"time_constant_s", "s", 1, 200, 5, 3000, 100,
                       "tether.heating.time_constant_s",
                       [](const Design& d) { return d.tether.heating.time_constant; }},
                      {"wind_cooling_sqrt_s_per_m", "(s/m)^0.5", 1, 0, 0, 3, 0.2,
                       "tether.heating.wind_cooling_sqrt_s_per_m",
                       [](const Design& d) { return d.tether.heating.wind_cooling; }}},
       .to_separate = "Hover at one height for ten minutes from a cold start: heating shows as a "
                      "drift of the resistance, everything else does not",
       .change = "R = 2hρ(T)/A, τ·dT/dt = T_ambient + k·I²R′/(1 + c·√v) − T",
       .channel = "time",
       .on_power =
           [](PowerModel& m, Values x) {
             m.design.tether.heating = {x[0], x[1], x[2]};
           }},

      {.id = "cable_temperature",
       .title = "The cable has the temperature of the air",
       .mechanism =
           "Without heat in the spec the cable counts at one temperature, whatever the air "
           "has: on a cold day it resists less, by 4 % for every 10 K.",
       .stage = Stage::tether,
       .parameters = {{"air_share", "1", 1, 0, -0.5, 1.5, 0.3}},
       .needs = {"ambient_temperature_C"},
       .to_separate = "Fly on days of different temperature, or give "
                      "tether.conductor_temperature_C as it was",
       .change = "T = T_spec + s·(T_air − T_spec)",
       .channel = "current_height",
       .on_power = [](PowerModel& m, Values x) { m.air_share += x[0]; },
       .lacking_in = [](const Design& design) -> std::string {
         return is_heated(design.tether)
                    ? "a spec whose cable has one temperature: this one has heat computed"
                    : "";
       }},

      {.id = "contact_resistance",
       .title = "Plugs or slip rings add resistance",
       .mechanism =
           "Contacts lose a voltage in proportion to the current, the same at every height.",
       .stage = Stage::tether,
       .parameters = {{"contact_resistance_ohm", "ohm", 1, 0, 0, 50, 0.1,
                       "tether.contact_resistance_ohm"}},
       .to_separate = to_separate_tether,
       .change = "R = 2hρ/A + R_c",
       .channel = "supply_current",
       .on_power = [](PowerModel& m, Values x) { m.design.tether.contact_resistance += x[0]; }},

      {.id = "spooled_length",
       .title = "Cable on the drum carries the current too",
       .mechanism = "The whole cable is in the circuit at every height: what is not in the air is "
                    "on the drum, with resistance but without airborne mass.",
       .stage = Stage::tether,
       // Any drum at all puts the whole cable into the circuit.
       .parameters = {{"spooled_length_m", "m", 1, 0, 1e-3, 1000, 10, "tether.spooled_length_m"}},
       .to_separate = to_separate_tether,
       .change = "R = 2(L + s)ρ/A at every height, L the design length",
       .channel = "supply_current",
       .on_power = [](PowerModel& m, Values x) { m.design.tether.spooled_length += x[0]; }},

      {.id = "tether_sag",
       .title = "More cable is out than the drone is high",
       .mechanism = "Slack makes the cable in the air longer than the height, by the same share at "
                    "every height, with its resistance and its weight.",
       .stage = Stage::tether,
       .parameters = {{"slack", "1", 1, 0, -0.2, 1, 0.05}},
       .to_separate = to_separate_lengths,
       .change = "L = h(1 + s)",
       .channel = "current_height",
       .on_power =
           [](PowerModel& m, Values x) {
             // A solved tether hangs with its slack; a straight one is only longer.
             Tether& tether = m.design.tether;
             const bool solved = tether.model == TetherModel::solved;
             (solved ? tether.slack : m.slack) += x[0];
             constexpr double taut = 1e-4;
             if (solved) tether.slack = std::max(tether.slack, taut);
           },
       .shows_in = {Stage::tether, Stage::motors, Stage::airframe},
       .of_tether = true,
       .lacking_in = [](const Design& design) -> std::string {
         if (!hangs_on_winch(design.tether)) return "";
         return "a length of cable that slack decides: here the winch's pull does "
                "(tether.winch_pull_N)";
       }},

      {.id = "height_bias",
       .title = "The height is read wrong",
       .mechanism = "The altimeter adds the same height everywhere, so as much cable seems to be "
                    "out, with its resistance and its weight.",
       .stage = Stage::tether,
       .parameters = {{"height_bias_m", "m", 1, 0, -50, 50, 1}},
       .to_separate = to_separate_lengths,
       .change = "h = h_read − b",
       .channel = "supply_current",
       .on_power = [](PowerModel& m, Values x) { m.instruments.height_offset += x[0]; },
       .shows_in = {Stage::tether, Stage::motors, Stage::airframe},
       .of_tether = true},

      {.id = "drone_voltage_offset",
       .title = "The voltmeter at the drone is off",
       .mechanism = "The same voltage is added to every reading at the converter's input, so the "
                    "tether seems to lose it even without a current.",
       .stage = Stage::converter,
       .parameters = {{"drone_voltage_offset_V", "V", 1, 0, -20, 20, 0.2}},
       .to_separate = to_separate_meters,
       .change = "U_d = U_read − U_0",
       .channel = "time",
       .on_power = [](PowerModel& m, Values x) { m.instruments.drone_voltage_offset += x[0]; },
       .shows_in = {Stage::tether, Stage::converter}},

      {.id = "converter_efficiency_curve",
       .title = "The converter's efficiency depends on its load",
       .mechanism = "A converter loses a fixed power and one that grows with the square of its "
                    "output, so it is best at one load and worse below and above.",
       .stage = Stage::converter,
       .parameters = {{"fixed_loss_W", "W", 1, 0, 0, 1000, 5, "supply.converter.losses.fixed_W",
                       [](const Design& d) { return d.supply.converter.losses.fixed; }},
                      {"square_loss_per_W", "1/W", 1, 0, 0, 0.02, 1e-5,
                       "supply.converter.losses.square_per_W",
                       [](const Design& d) { return d.supply.converter.losses.square; }}},
       .sizes = 2,
       .to_separate = to_separate_converter,
       .change = "P_in = P_out + P_0 + c·P_out²",
       .channel = "bus_power",
       .on_power =
           [](PowerModel& m, Values x) {
             m.design.supply.converter.losses = {x[0], x[1]};
           }},

      {.id = "auxiliary_power",
       .title = "Payload and electronics draw another power",
       .mechanism = "Flight controller and payload draw a constant power at the converter's input "
                    "that differs from the spec's.",
       .stage = Stage::converter,
       .parameters = {{"extra_auxiliary_power_W", "W", 1, 0, -200, 500, 2,
                       "drone.auxiliary_power_W"}},
       .to_separate = to_separate_converter,
       .change = "P_aux + ΔP",
       .channel = "bus_power",
       .on_power = [](PowerModel& m, Values x) { m.design.drone.auxiliary_power += x[0]; }},

      {.id = "bus_current_gain",
       .title = "The ammeter at the motors reads wrong",
       .mechanism = "The bus current is read too high or too low by one factor, at the converter's "
                    "output and at the motors alike.",
       .stage = Stage::motors,
       .parameters = {{"bus_current_gain", "1", 1, 1, 0.5, 2, 0.03}},
       .to_separate = to_separate_meters,
       .change = "I_bus = I_read/g",
       .channel = "bus_power",
       .on_power = [](PowerModel& m, Values x) { m.instruments.bus_current_gain *= x[0]; },
       .shows_in = {Stage::converter, Stage::motors}},

      {.id = "motor_power_scale",
       .title = "The motors need more, or less, power than their data sheet says",
       .mechanism = "Worn bearings, other propellers or thin air scale the power for every thrust "
                    "by one factor.",
       .stage = Stage::motors,
       .parameters = {{"motor_power_factor", "1", 1, 1, 0.3, 4, 0.05, "drone.motor_power_factor"}},
       .to_separate = to_separate_motors,
       .change = "f·P_motor(T)",
       .channel = "height",
       .on_power = [](PowerModel& m, Values x) { m.design.drone.motor_power_factor *= x[0]; }},

      {.id = "motor_ageing",
       .title = "The motors need more, or less, power from minute to minute",
       .mechanism = "Warming windings, wear or a propeller that suffers raise the power for the "
                    "same thrust steadily from the first sample to the last.",
       .stage = Stage::motors,
       .parameters = {{"motor_power_growth", "1", 1, 0, -0.6, 3, 0.05}},
       .to_separate = "Repeat the first manoeuvre at the end, and again after a rest",
       .change = "P·(1 + a·t/t_log)",
       .channel = "time",
       .on_power = [](PowerModel& m, Values x) { m.motor_power_growth += x[0]; }},

      {.id = "climb_power",
       .title = "Climbing takes power, and sinking gives some back",
       .mechanism = "Every metre of height is work against the weight, which the simulation of "
                    "steady flight leaves out; rotors that climb have a little less to induce.",
       .stage = Stage::motors,
       .parameters = {{"climb_work_factor", "1", 1, 0, -1, 5, 0.3}},
       .needs = {"height_m"},
       .to_separate = "Climb and sink at several speeds, with hover between",
       .change = "P + f·W·dh/dt",
       .channel = "height",
       .on_power = [](PowerModel& m, Values x) { m.climb_work += x[0]; }},

      {.id = "air_density",
       .title = "The air is thinner, or denser, than the spec says",
       .mechanism =
           "Thin air needs more induced power for the same thrust, with the inverse square "
           "root of the density (momentum theory), and drags less.",
       .stage = Stage::motors,
       .parameters = {{"air_density_factor", "1", 1, 1, 0.5, 1.5, 0.05,
                       "flight.air_density_kg_m3"}},
       .to_separate = "Read barometer and thermometer: they give the density to half a percent",
       .change = "f·ρ, P_motor/√f",
       .channel = "airspeed",
       .on_power =
           [](PowerModel& m, Values x) {
             m.design.flight.air_density *= x[0];
             // A bench of known density has the motors' curve scaled with that of the flight.
             if (bench_air_density(m.design.drone)) return;
             m.design.drone.motor_power_factor /= std::sqrt(x[0]);
           },
       .shows_in = {Stage::motors, Stage::airframe},
       .bends_tether = true},

      {.id = "translational_lift",
       .title = "Moving through the air saves hover power",
       .mechanism = "In forward flight the rotors take in more air, so the induced part of the "
                    "power falls with airspeed, until leaning against the drag costs more.",
       .stage = Stage::motors,
       .parameters =
           {{"induced_share", "1", 1, 0, 0, 0.95, 0.05, "drone.translational_lift.induced_share",
             [](const Design& d) { return d.drone.translational_lift.induced_share; }},
            {"hover_induced_speed_m_s", "m/s", 1, 6, 3, 10, 2,
             "drone.translational_lift.hover_induced_speed_m_s",
             [](const Design& d) { return d.drone.translational_lift.hover_induced_speed; }}},
       .to_separate = to_separate_airspeed,
       .change = "P·(1 − s·(1 − λ)), (λ − μ·sinα)·√(μ²cos²α + λ²) = 1, μ = v/v_h, α the tilt",
       .channel = "airspeed",
       .on_power =
           [](PowerModel& m, Values x) {
             m.design.drone.translational_lift = {x[0], x[1]};
           }},

      {.id = "extra_mass",
       .title = "The drone is heavier, or lighter, than the spec says",
       .mechanism = "More weight needs more thrust at every height and airspeed.",
       .stage = Stage::airframe,
       .parameters = {{"extra_mass_kg", "kg", 1, 0, -0.5, 5, 0.05, "drone.mass_g"}},
       .to_separate = to_separate_motors,
       .change = "m_d + Δm",
       .channel = "height",
       .no_flight_shows_because =
           "a wrong mass only rescales the drag areas, since both enter as force over mass",
       .on_power = [](PowerModel& m, Values x) { m.design.drone.mass += x[0]; }},

      {.id = "payload_drop",
       .title = "The drone becomes lighter at once",
       .mechanism = "From one moment on the motors lift less: a payload was dropped, or whatever "
                    "else hung below.",
       .stage = Stage::airframe,
       .parameters = {{"payload_drop_kg", "kg", 1, 0, 0, 20, 0.05},
                      {.name = "payload_drop_time_s",
                       .unit = "s",
                       .look_through = LookThrough::moments}},
       .to_separate = "Weigh the drone before and after; motors that change at once, such as one "
                      "that fails, draw another power at every thrust",
       .change = "m_d − Δm from the time on",
       .channel = "time",
       .on_power =
           [](PowerModel& m, Values x) {
             m.dropped_mass = x[0];
             m.drop_time = x[1];
           },
       // To the tilt it is a mass that drops, which the flight is asked for itself.
       .shows_in = {Stage::motors}},

      {.id = "winch_tension",
       .title = "The winch pulls harder, or less, than assumed",
       .mechanism =
           "A pull on the tether loads the drone at every height alike, like weight where it "
           "hangs straight; where it is solved, the pull also decides how much is out.",
       .stage = Stage::airframe,
       .parameters = {{"winch_pull_N", "N", 1, 0, 0, 500, 0.5, "tether.winch_pull_N",
                       [](const Design& d) { return d.tether.winch_pull; }}},
       .to_separate = "Weigh the drone, and put a spring scale between winch and tether",
       .change = "F_winch",
       .channel = "height",
       .on_power = [](PowerModel& m, Values x) { m.design.tether.winch_pull = x[0]; },
       .of_tether = true,
       .bends_tether = true,
       .twin_of = "extra_mass",
       .lacking_in = [](const Design& design) -> std::string {
         const Tether& tether = design.tether;
         if (tether.model == TetherModel::straight || hangs_on_winch(tether)) return "";
         return "a winch whose pull decides the length of cable: here slack does "
                "(tether.slack_percent)";
       }},

      {.id = "airspeed_scale",
       .title = "The airspeed is read wrong",
       .mechanism =
           "The airspeed is read too high or too low by one factor, and with it everything "
           "that the wind does.",
       .stage = Stage::airframe,
       .parameters = {{"airspeed_gain", "1", 1, 1, 0.3, 3, 0.05}},
       .to_separate = "Compare the airspeed with that of another sensor, or fly both ways over the "
                      "ground in still air",
       .change = "v = v_read/g",
       .channel = "airspeed",
       .on_power = [](PowerModel& m, Values x) { m.instruments.airspeed_gain *= x[0]; },
       .shows_in = {Stage::motors},
       .bends_tether = true},

      {.id = "tether_drag",
       .title = "The tether drags more, or less, than assumed",
       .mechanism = "The wind's force on the cable grows with deployed length and the square of "
                    "the airspeed, and the drone tilts against it.",
       .stage = Stage::airframe,
       .parameters = {{"tether_drag_factor", "1", 1, 1, 0, 10, 0.2, "tether.drag_coefficient"}},
       .to_separate = to_separate_airspeed,
       .change = "f·C",
       .channel = "airspeed",
       .on_power = [](PowerModel& m, Values x) { m.design.tether.drag_coefficient *= x[0]; },
       .of_tether = true,
       .bends_tether = true},

      {.id = "airframe_drag",
       .title = "The drone drags more, or less, than assumed",
       .mechanism = "Payload or landing gear scale the drag of the drone, which it "
                    "tilts against at every height.",
       .stage = Stage::airframe,
       .parameters = {{"airframe_drag_factor", "1", 1, 1, 0, 10, 0.2, "drone.drag"}},
       .to_separate = to_separate_airspeed,
       .change = "f·A_f, f·A_t",
       .channel = "airspeed",
       .on_power = [](PowerModel& m, Values x) {
         m.design.drone.drag.front_area *= x[0];
         m.design.drone.drag.top_area *= x[0];
       }}};
  for (Effect& effect : effects) {
    effect.log = LogKind::power;
    if (effect.shows_in.empty()) effect.shows_in = shown_by(effect.stage);
    constexpr bool free_flight = true;  // on a tether the motors need the height as well
    for (std::string& channel : channels_needed(effect.shows_in, free_flight)) {
      if (!contains(effect.needs, channel)) effect.needs.push_back(std::move(channel));
    }
    effect.parameters.front().start = effect.parameters.front().scale;
  }
  return effects;
}

}  // namespace tethercalc
