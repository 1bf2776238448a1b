#include "tethercalc/io/spec_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <stdexcept>
#include <type_traits>

#include "io/closest_name.hpp"
#include "io/json_document.hpp"
#include "model/constants.hpp"
#include "tethercalc/model/drum_package.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

// Upper ends of ranges are no physics: they stand well beyond anything that flies, so that a slip
// of the unit (kilograms for grams, kilometres for metres) is told instead of computed.
constexpr FieldRange any_number{};
constexpr FieldRange positive_fraction{0, 1, true, false};

constexpr FieldRange between(double min, double max) { return {min, max, false, false}; }
constexpr FieldRange above(double min, double max) { return {min, max, true, false}; }
constexpr FieldRange inside(double min, double max) { return {min, max, true, true}; }

using enum FieldKind;

/// The member of a design at the end of `path`.
template <auto... path>
auto& at(Design& design) {
  return (design.*....*path);
}

constexpr std::array all_spec_fields{
    SpecField{"/$schema", text, "", any_number, "\"\"",
              "Path or address of the JSON Schema, by which editors check and complete the file."},
    SpecField{"/name", text, "", any_number, "\"\"",
              "What reports call the design; the file's name where absent."},
    SpecField{"/description", text, "", any_number, "\"\"", "Free text."},
    SpecField{"/notes", text, "", any_number, "\"\"",
              "Free text, for remarks: JSON has no comments."},
    SpecField{"/drone/mass_g", number, "g", between(least_drone_mass / unit::gram, 1e6), "",
              "Mass of the drone ready to fly, without the tether.", unit::gram,
              at<&Design::drone, &Drone::mass>},
    SpecField{"/drone/motor_count", integer, "", between(1, 64), "", "Number of motors, all alike.",
              1, at<&Design::drone, &Drone::motor_count>},
    SpecField{"/drone/motor", motor, "", any_number, "",
              "Motor with its propeller: a name in the library, a file, or an object."},
    SpecField{
        "/drone/motor_air_density_kg_m3", optional_number, "kg/m³", between(0.001, 100), "null",
        "Density of the air in which the motor's curve was measured, where the motor's file "
        "does not state it or is wrong; the curve is then scaled to flight.air_density_kg_m3.",
        1, at<&Design::drone, &Drone::motor_air_density>},
    SpecField{"/drone/motor_power_factor", number, "", above(0, 10), "1",
              "The motors draw this times what the motor's curve says.", 1,
              at<&Design::drone, &Drone::motor_power_factor>},
    SpecField{"/drone/auxiliary_power_W", number, "W", between(0, 1e5), "0",
              "Power of flight controller and payload, at the converter's input.", 1,
              at<&Design::drone, &Drone::auxiliary_power>},
    SpecField{
        "/drone/drag/front_area_m2", number, "m²", between(0, 100), "",
        "Drag area of the level drone, drag coefficient included. Without drone.drag all of it is "
        "estimated from the mass.",
        1, at<&Design::drone, &Drone::drag, &AirframeDrag::front_area>},
    SpecField{"/drone/drag/top_area_m2", number, "m²", between(0, 100), "",
              "Drag area of the drone tilted by 90°, drag coefficient included.", 1,
              at<&Design::drone, &Drone::drag, &AirframeDrag::top_area>},
    SpecField{"/drone/drag/linear_m_s", number, "m/s", between(0, 1000), "0",
              "Airspeed at which linear and quadratic drag are equal.", 1,
              at<&Design::drone, &Drone::drag, &AirframeDrag::linear_speed>},
    SpecField{"/drone/drag/fore_aft_asymmetry", number, "", inside(-1, 1), "0",
              "Drag is 1 + this times as large flying forward, 1 - this flying backward.", 1,
              at<&Design::drone, &Drone::drag, &AirframeDrag::fore_aft_asymmetry>},
    SpecField{
        "/drone/translational_lift/induced_share", number, "", between(0, 0.95), "0",
        "Part of the hover power that is induced: it falls with airspeed, and grows with the lean.",
        1, at<&Design::drone, &Drone::translational_lift, &TranslationalLift::induced_share>},
    SpecField{
        "/drone/translational_lift/hover_induced_speed_m_s", number, "m/s", above(0, 100), "6",
        "Speed of the air through the rotor discs in hover.", 1,
        at<&Design::drone, &Drone::translational_lift, &TranslationalLift::hover_induced_speed>},
    SpecField{"/drone/reserve_battery/specific_energy_Wh_kg", number, "Wh/kg", between(0, 1000),
              "0",
              "Energy per mass of a battery that lands the drone from its height if the tether "
              "fails; its mass, as the landing asks for, comes to mass_g. 0: there is none.",
              3600, at<&Design::drone, &Drone::reserve_battery, &ReserveBattery::specific_energy>},
    SpecField{"/drone/reserve_battery/usable_share", number, "", positive_fraction, "0.8",
              "Part of its energy that the landing may use.", 1,
              at<&Design::drone, &Drone::reserve_battery, &ReserveBattery::usable_share>},
    SpecField{"/drone/reserve_battery/discharge_C", number, "1/h", above(0, 1000), "10",
              "Most power it gives over its energy: its C rating.", 1 / 3600.0,
              at<&Design::drone, &Drone::reserve_battery, &ReserveBattery::discharge_rate>},
    SpecField{"/drone/reserve_battery/descent_speed_m_s", number, "m/s", above(0, 50), "1.5",
              "Speed of the landing.", 1,
              at<&Design::drone, &Drone::reserve_battery, &ReserveBattery::descent_speed>},
    SpecField{"/tether/length_m", number, "m", between(least_tether_length, 1e4), "",
              "Length of the tether in the air, which is the flight height.", 1,
              at<&Design::tether, &Tether::length>},
    SpecField{
        "/tether/spooled_length_m", number, "m", between(0, 1e4), "0",
        "Length left on the drum: it adds resistance, but neither mass nor drag. A solved tether "
        "pays out no more than there is; without any it is as long as it takes.",
        1, at<&Design::tether, &Tether::spooled_length>},
    SpecField{"/tether/conductor", conductor, "", any_number, "",
              "Conductor material: a name in the library, a file, or an object."},
    SpecField{"/tether/conductor_temperature_C", number, "°C", between(-50, 250), "20",
              "Temperature of the conductor, on which its resistance depends.", 1,
              at<&Design::tether, &Tether::conductor_temperature_C>},
    SpecField{"/tether/insulation/material", insulation_material, "", any_number, "",
              "Insulation material: a name in the library, a file, or an object."},
    SpecField{"/tether/insulation/thickness_mm", number, "mm", between(0, 100), "",
              "Wall thickness of the insulation of each conductor; the least one, for handling, "
              "where dielectric_safety_factor asks for more.",
              unit::millimetre, at<&Design::tether, &Tether::insulation, &Insulation::thickness>},
    SpecField{"/tether/insulation/dielectric_safety_factor", number, "", between(0, 1000), "0",
              "How many times the supply voltage the wall stands by the material's breakdown "
              "strength; the wall grows with the voltage accordingly. 0: it does not.",
              1, at<&Design::tether, &Tether::insulation, &Insulation::dielectric_safety_factor>},
    SpecField{"/tether/contact_resistance_ohm", number, "Ω", between(0, 1000), "0",
              "Resistance of plugs and slip rings in the whole loop.", 1,
              at<&Design::tether, &Tether::contact_resistance>},
    SpecField{"/tether/stranding_factor", number, "", between(1, 2), "1",
              "Resistance of a conductor over that of solid wire of its cross-section: 1.08 to "
              "1.10 for fine strands (class 5 over class 1 of IEC 60228).",
              1, at<&Design::tether, &Tether::stranding_factor>},
    SpecField{"/tether/cover/mass_g_m", number, "g/m", between(0, 1e4), "0",
              "Mass of a common jacket, fillers and fibres that carry no pull, per metre.",
              unit::gram, at<&Design::tether, &Tether::cover_mass>},
    SpecField{
        "/tether/cover/width_mm", number, "mm", between(0, 100), "0",
        "Width that these add to that of both conductors side by side, in the wind and on the "
        "drum; how they hinder heat is not counted.",
        unit::millimetre, at<&Design::tether, &Tether::cover_width>},
    SpecField{"/tether/drag_coefficient", number, "", between(0, 10), "1.0",
              "Drag coefficient of a conductor across the wind.", 1,
              at<&Design::tether, &Tether::drag_coefficient>},
    SpecField{
        "/tether/drag_by_reynolds_number", boolean, "", any_number, "false",
        "Whether drag_coefficient is times that of a smooth cylinder as thick as one insulated "
        "conductor in the wind it meets: 1.45 at a Reynolds number of 100, 0.96 at 1000. Of a "
        "solved tether only.",
        1, at<&Design::tether, &Tether::drag_by_reynolds_number>},
    SpecField{
        "/tether/vibration_amplitude", number, "", between(0, 2), "0",
        "Amplitude with which the tether vibrates across the wind over its width; drag is 1 + 2.1 "
        "times this as large. A cable that beats in its own wake reaches 0.5 to 1.",
        1, at<&Design::tether, &Tether::vibration_amplitude>},
    SpecField{
        "/tether/projection_factor", number, "", between(0, 1), "0.75",
        "Mean width that the turning pair shows the wind, over the width of both side by side.", 1,
        at<&Design::tether, &Tether::projection_factor>},
    SpecField{"/tether/cross_section_mm2", optional_number, "mm²", above(0, 1e6), "null",
              "Cross-section of one conductor, where the cable is already chosen.",
              unit::square_millimetre, at<&Design::tether, &Tether::cross_section>},
    SpecField{"/tether/ambient_temperature_C", optional_number, "°C", between(-60, 90), "null",
              "Temperature of the air. Set, the conductor's temperature is that of a heat balance, "
              "and conductor_temperature_C is not used.",
              1, at<&Design::tether, &Tether::ambient_temperature_C>},
    SpecField{"/tether/heating/rise_K_m_per_W", number, "K·m/W", between(0, 1000), "0",
              "Measured rise of the conductor's temperature over that of the air, per loss of the "
              "loop in still air; takes the place of the heat balance. 0: not measured.",
              1, at<&Design::tether, &Tether::heating, &MeasuredHeating::rise_per_loss>},
    SpecField{"/tether/heating/time_constant_s", number, "s", above(0, 1e5), "200",
              "Time in which the rise follows the loss; steady flight does not depend on it.", 1,
              at<&Design::tether, &Tether::heating, &MeasuredHeating::time_constant>},
    SpecField{"/tether/heating/wind_cooling_sqrt_s_per_m", number, "(s/m)^0.5", between(0, 100),
              "0", "The rise is divided by 1 + this times the square root of the airspeed.", 1,
              at<&Design::tether, &Tether::heating, &MeasuredHeating::wind_cooling>},
    SpecField{
        "/tether/inclination_deg", optional_number, "°", between(0, 90), "null",
        "Angle of the tether over the ground, for its heat: 90 hangs straight down, where still "
        "air cools a wire about half as well. Unset: wind across it, and still air as along a "
        "horizontal conductor, less 7 %.",
        unit::degree, at<&Design::tether, &Tether::inclination>},
    SpecField{"/tether/sun_W_m2", number, "W/m²", between(0, 1500), "0",
              "Sunlight across the tether in the air; matters with ambient_temperature_C.", 1,
              at<&Design::tether, &Tether::sun>},
    SpecField{"/tether/drum/layers", integer, "", between(0, 4), "0",
              "Layers of tether on a ventilated cylindrical drum, which set its current derating; "
              "0: not stated.",
              1, at<&Design::tether, &Tether::drum, &Drum::layers>},
    SpecField{"/tether/drum/derating", optional_number, "", positive_fraction, "null",
              "Current that the tether may carry on the drum over what it may laid out, where that "
              "is known; goes before layers and package.",
              1, at<&Design::tether, &Tether::drum, &Drum::derating>},
    SpecField{"/tether/drum/core_diameter_mm", number, "mm", between(0, 1e4), "0",
              "Diameter that the tether is wound on. With width_mm the temperature on the drum is "
              "that of the wound package, in place of what layers say; 0: not stated.",
              unit::millimetre, at<&Design::tether, &Tether::drum, &Drum::core_diameter>},
    SpecField{"/tether/drum/width_mm", number, "mm", between(0, 1e4), "0",
              "Width of the drum between its flanges, where a turn of the tether has to fit; 0: "
              "not stated.",
              unit::millimetre, at<&Design::tether, &Tether::drum, &Drum::width>},
    SpecField{"/tether/drum/package_conductivity_W_mK", optional_number, "W/(m·K)",
              between(0.01, 10), "null",
              "Thermal conductivity across the wound wires; where unknown, that of the wires with "
              "air between them.",
              1, at<&Design::tether, &Tether::drum, &Drum::package_conductivity>},
    SpecField{"/tether/strength_member/material", strength_material, "", any_number, "\"none\"",
              "Fibres that carry the pull.", 1,
              at<&Design::tether, &Tether::strength_member, &StrengthMember::material>},
    SpecField{"/tether/strength_member/cross_section_mm2", number, "mm²", between(0, 1000), "0",
              "Cross-section of the fibres.", unit::square_millimetre,
              at<&Design::tether, &Tether::strength_member, &StrengthMember::cross_section>},
    SpecField{
        "/tether/winch_pull_N", number, "N", between(0, 1e5), "0",
        "Pull of the winch on the tether, which the drone holds up; of a solved tether, the "
        "tension that the winch holds at the station, which decides how much is out. 0: none.",
        1, at<&Design::tether, &Tether::winch_pull>},
    SpecField{
        "/tether/model", tether_model, "", any_number, "\"straight\"",
        "How the tether hangs: straight down with all its drag on the drone, or solved, as its "
        "weight and the wind have it.",
        1, at<&Design::tether, &Tether::model>},
    SpecField{
        "/tether/slack_percent", number, "%", between(1e-4, 1000), "1",
        "Tether paid out beyond the distance to the drone, of a solved one that no winch pulls.",
        0.01, at<&Design::tether, &Tether::slack>},
    SpecField{"/tether/axial_stiffness_N", optional_number, "N", between(1, 1e12), "null",
              "EA of the solved tether: how much force stretches it by its own length; without, it "
              "does not stretch.",
              1, at<&Design::tether, &Tether::axial_stiffness>},
    SpecField{"/supply/voltage_V", number, "V", between(1, 1e4), "",
              "Voltage of the supply at the ground end of the tether.", 1,
              at<&Design::supply, &Supply::voltage>},
    SpecField{"/supply/converter/efficiency", efficiency, "", positive_fraction, "",
              "Efficiency of the converter on the drone: a number, or a list of points over its "
              "output power.",
              1, at<&Design::supply, &Supply::converter>},
    SpecField{"/supply/converter/losses/fixed_W", number, "W", between(0, 1e5), "0",
              "Power that the converter loses at any load. Where this or square_per_W is given, "
              "input = output + fixed_W + square_per_W * output², and efficiency is not used.",
              1,
              at<&Design::supply, &Supply::converter, &Converter::losses, &ConverterLosses::fixed>},
    SpecField{
        "/supply/converter/losses/square_per_W", number, "1/W", between(0, 1), "0",
        "Loss that grows with the square of the output, over that square.", 1,
        at<&Design::supply, &Supply::converter, &Converter::losses, &ConverterLosses::square>},
    SpecField{"/supply/converter/min_input_voltage_V", number, "V", between(0, 1e4), "",
              "Voltage at its input below which the converter cuts off.", 1,
              at<&Design::supply, &Supply::converter, &Converter::min_input_voltage>},
    SpecField{"/supply/converter/max_input_voltage_V", optional_number, "V", above(0, 1e4), "null",
              "Highest voltage that the converter's input stands.", 1,
              at<&Design::supply, &Supply::converter, &Converter::max_input_voltage>},
    SpecField{"/supply/converter/rated_output_W", optional_number, "W", above(0, 1e6), "null",
              "Power that the converter gives continuously, at most.", 1,
              at<&Design::supply, &Supply::converter, &Converter::rated_output_power>},
    SpecField{"/supply/converter/specific_mass_kg_per_kW", number, "kg/kW", between(0, 100), "0",
              "Mass of the converter per rated output, which the drone carries beside its own.",
              1e-3, at<&Design::supply, &Supply::converter, &Converter::specific_mass>},
    SpecField{"/supply/converter/mass_table", converter_masses, "", any_number, "[]",
              "Instead of that, what converters weigh: points over their rated output.", 1,
              at<&Design::supply, &Supply::converter>},
    SpecField{"/supply/converter/fixed_ratio", optional_number, "", above(0, 100), "null",
              "Output over input voltage of a converter whose output follows its input.", 1,
              at<&Design::supply, &Supply::converter, &Converter::fixed_ratio>},
    SpecField{"/supply/converter/min_output_voltage_V", number, "V", between(0, 1e4), "0",
              "Voltage that the motors need behind a converter of fixed ratio.", 1,
              at<&Design::supply, &Supply::converter, &Converter::min_output_voltage>},
    SpecField{"/flight/airspeed_m_s", number, "m/s", between(0, 200), "",
              "Airspeed in forward flight.", 1, at<&Design::flight, &Flight::airspeed>},
    SpecField{"/flight/headwind_m_s", number, "m/s", between(-200, 200), "0",
              "Wind from the front, added to the airspeed in hover and in forward flight.", 1,
              at<&Design::flight, &Flight::headwind>},
    SpecField{"/flight/air_density_kg_m3", number, "kg/m³", between(0.001, 100), "",
              "Density of the air; 1.225 at 15 °C and sea level (ISO 2533).", 1,
              at<&Design::flight, &Flight::air_density>},
    SpecField{"/flight/gravity_m_s2", number, "m/s²", between(0.1, 100), "9.80665",
              "Acceleration of gravity.", 1, at<&Design::flight, &Flight::gravity>},
    SpecField{"/flight/horizontal_offset_m", number, "m", between(0, 1e4), "0",
              "How far the drone stands aside of its station, upwind; for a solved tether.", 1,
              at<&Design::flight, &Flight::horizontal_offset>},
    SpecField{"/flight/station_height_m", number, "m", between(0, 1e4), "0",
              "Height of the tether's lower end over ground; matters with a wind profile.", 1,
              at<&Design::flight, &Flight::station_height>},
    SpecField{"/flight/wind_profile", wind_profile, "", any_number, "\"uniform\"",
              "How the wind grows with height over ground.", 1,
              at<&Design::flight, &Flight::wind_profile>},
    SpecField{"/flight/wind_exponent", number, "", between(0, 1), "0.14285714285714285",
              "Exponent of the power law; 1/7 over open land.", 1,
              at<&Design::flight, &Flight::wind_exponent>},
    SpecField{"/flight/roughness_length_m", number, "m", between(1e-6, 10), "0.03",
              "Roughness length of the logarithmic profile; 0.03 over grass.", 1,
              at<&Design::flight, &Flight::roughness_length>},
    SpecField{
        "/flight/wind_reference_height_m", optional_number, "m", between(0.1, 1e4), "null",
        "Height over ground at which headwind_m_s blows, by the profile; without, it blows at "
        "the drone.",
        1, at<&Design::flight, &Flight::wind_reference_height>},
    SpecField{"/requirements/thrust_headroom", number, "", between(1, 100), "2.0",
              "Thrust that the available power makes over the thrust needed, at least.", 1,
              at<&Design::requirements, &Requirements::thrust_headroom>},
    SpecField{"/requirements/headroom_at", condition, "", any_number, "\"hover\"",
              "Flight condition in which the headroom is demanded.", 1,
              at<&Design::requirements, &Requirements::headroom_at>},
    SpecField{"/requirements/power_at", condition, "", any_number, "\"forward\"",
              "Flight condition in which the power is minimised.", 1,
              at<&Design::requirements, &Requirements::power_at>},
    SpecField{"/requirements/max_pitch_deg", number, "°", inside(0, 90), "45",
              "Largest tilt of the drone.", unit::degree,
              at<&Design::requirements, &Requirements::max_pitch>},
    SpecField{"/requirements/buffer_battery", boolean, "", any_number, "false",
              "A battery on board covers peaks of thrust: headroom is reported, not enforced.", 1,
              at<&Design::requirements, &Requirements::buffer_battery>},
    SpecField{
        "/requirements/strength_safety_factor", number, "", between(0, 1000), "0",
        "Breaking load of the tether over its tension at the drone, at least; 0: not asked for.", 1,
        at<&Design::requirements, &Requirements::strength_safety_factor>},
};

constexpr SpecField id_field{"/id", text, "", any_number, "\"\"", "Name in the library."};
constexpr SpecField name_field{"/name", text, "", any_number, "\"\"", "What reports call it."};
constexpr SpecField source_field{"/source",  text,   "",
                                 any_number, "\"\"", "Where the numbers come from."};
constexpr SpecField density_field(double& (*access)(Design&)) {
  return {"/density_g_cm3",
          FieldKind::number,
          "g/cm³",
          between(0.01, 30),
          "",
          "Density.",
          unit::gram_per_cubic_centimetre,
          access};
}

constexpr std::array all_motor_fields{
    id_field,
    name_field,
    source_field,
    SpecField{"/voltage_V", optional_number, "V", above(0, 1000), "null",
              "Voltage at which it was measured."},
    SpecField{"/propeller_in", optional_number, "inch", above(0, 200), "null",
              "Diameter of the propeller."},
    SpecField{"/measured_air_density_kg_m3", optional_number, "kg/m³", between(0.001, 100), "null",
              "Density of the air in which it was measured; where unknown, the curve counts in any "
              "air."},
    SpecField{"/power_uncertainty_percent", optional_number, "%", above(0, 100), "null",
              "Where the points are an estimate: the power may be off by about this much, which "
              "every answer then says."},
    SpecField{"/points", motor_points, "", any_number, "",
              "Measured points of one motor with its propeller, two at least."}};

constexpr std::array all_motor_point_fields{
    SpecField{"/throttle_percent", optional_number, "%", between(0, 100), "null",
              "Throttle; not used."},
    SpecField{"/thrust_g", number, "gram-force", above(0, 1e6), "", "Static thrust.",
              unit::gram_force},
    SpecField{"/efficiency_g_per_W", optional_number, "gram-force/W", between(1e-3, 1e4), "null",
              "Thrust over electrical power; this or power_W."},
    SpecField{"/power_W", optional_number, "W", above(0, 1e6), "null",
              "Electrical input power; this or efficiency_g_per_W."}};

constexpr std::array all_conductor_fields{
    id_field, name_field, source_field,
    SpecField{"/resistivity_20C_ohm_mm2_per_m", number, "Ω·mm²/m", between(1e-3, 10), "",
              "Resistivity at 20 °C.", unit::ohm_square_millimetre_per_metre,
              at<&Design::tether, &Tether::conductor, &Conductor::resistivity_20C>},
    // With the temperatures allowed above, the resistivity stays positive.
    SpecField{"/temperature_coefficient_per_K", number, "1/K", between(0, 0.01), "",
              "Temperature coefficient of the resistivity, relative to 20 °C.", 1,
              at<&Design::tether, &Tether::conductor, &Conductor::temperature_coefficient>},
    density_field(at<&Design::tether, &Tether::conductor, &Conductor::density>),
    SpecField{"/tensile_strength_MPa", optional_number, "MPa", above(0, 1e4), "null",
              "Tensile strength; where unknown, no load is hung on the conductors.",
              unit::megapascal,
              at<&Design::tether, &Tether::conductor, &Conductor::tensile_strength>}};

constexpr std::array all_insulation_fields{
    id_field,
    name_field,
    source_field,
    density_field(at<&Design::tether, &Tether::insulation, &Insulation::density>),
    SpecField{"/rated_temperature_C", optional_number, "°C", between(0, 400), "null",
              "Highest continuous conductor temperature.", 1,
              at<&Design::tether, &Tether::insulation, &Insulation::rated_temperature_C>},
    SpecField{"/thermal_conductivity_W_mK", optional_number, "W/(m·K)", between(0.01, 10), "null",
              "Thermal conductivity; 0.17 is taken where unknown.", 1,
              at<&Design::tether, &Tether::insulation, &Insulation::thermal_conductivity>},
    SpecField{"/breakdown_kV_mm", optional_number, "kV/mm", between(0.1, 1000), "null",
              "Breakdown strength of a short test.", unit::kilovolt_per_millimetre,
              at<&Design::tether, &Tether::insulation, &Insulation::breakdown_strength>}};

constexpr std::array all_efficiency_point_fields{
    SpecField{"/output_W", number, "W", between(0, 1e6), "", "Output power."},
    SpecField{"/efficiency", number, "", positive_fraction, "",
              "Efficiency at that output power."}};

constexpr std::array all_converter_mass_fields{
    SpecField{"/rated_output_W", number, "W", above(0, 1e6), "", "Rated output."},
    SpecField{"/mass_g", number, "g", between(0, 1e6), "", "Mass of such a converter.",
              unit::gram}};

/// The fields of a spec, each followed by the numbers of the material that it holds.
std::span<const SpecField> fields_and_material_numbers() {
  static std::deque<std::string> pointers;  // what the fields' views look at
  static const std::vector<SpecField> all = [] {
    std::vector<SpecField> fields;
    for (const SpecField& field : all_spec_fields) {
      fields.push_back(field);
      for (SpecField part : object_fields(field.kind)) {
        if (!is_numeric(part)) continue;
        part.pointer =
            pointers.emplace_back(std::string(field.pointer) + std::string(part.pointer));
        fields.push_back(part);
      }
    }
    return fields;
  }();
  return all;
}

/// The dot path of the field that somebody who wrote `path` probably meant, also where only its
/// last part was given ("voltage"); nothing where none is near.
std::optional<std::string> closest_field_path(std::string_view path) {
  const std::string wanted = dot_path(path);
  std::vector<std::string> paths;
  std::vector<std::string> keys;
  for (const SpecField& field : fields_and_material_numbers()) {
    paths.push_back(dot_path(field.pointer));
    keys.emplace_back(last_key(field.pointer));
  }
  // "supply.length_m": the key decides where it is a known one, whatever stands before it.
  const std::string key = wanted.substr(wanted.rfind('.') + 1);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == key) return paths[i];
  }
  if (const auto near_path = closest_name(wanted, paths)) return near_path;
  const auto near_key = closest_name(key, keys);
  for (std::size_t i = 0; near_key && i < keys.size(); ++i) {
    if (keys[i] == *near_key) return paths[i];
  }
  return std::nullopt;
}

template <typename T>
using Access = T& (*)(Design&);

}  // namespace

bool FieldRange::contains(double value) const {
  return (min_excluded ? value > min : value >= min) && (max_excluded ? value < max : value <= max);
}

std::span<const SpecField> spec_fields() { return all_spec_fields; }

std::span<const SpecField> object_fields(FieldKind kind) {
  static const std::map<FieldKind, std::span<const SpecField>> all{
      {motor, all_motor_fields},
      {motor_points, all_motor_point_fields},
      {conductor, all_conductor_fields},
      {insulation_material, all_insulation_fields},
      {efficiency, all_efficiency_point_fields},
      {converter_masses, all_converter_mass_fields}};
  const auto found = all.find(kind);
  return found == all.end() ? std::span<const SpecField>() : found->second;
}

std::string dot_path(std::string_view pointer) {
  std::string path(pointer.substr(pointer.starts_with('/') ? 1 : 0));
  for (char& c : path) {
    if (c == '/') c = '.';
  }
  return path;
}

const SpecField* find_field(std::string_view path) {
  const std::string wanted = dot_path(path);
  for (const SpecField& field : fields_and_material_numbers()) {
    if (dot_path(field.pointer) == wanted) return &field;
  }
  return nullptr;
}

std::string no_such_field(std::string_view path) {
  const auto closest = closest_field_path(path);
  return fmt::format("no field {} in a spec{}", shown(std::string(path)),
                     closest ? "; did you mean \"" + *closest + "\"?" : "");
}

std::string describe_range(const SpecField& field) {
  const FieldRange& range = field.range;
  std::string text;
  if (std::isfinite(range.min)) {
    text = fmt::format("{} {}", range.min_excluded ? "above" : "at least", range.min);
  }
  if (std::isfinite(range.max)) {
    if (!text.empty()) text += " and ";
    text += fmt::format("{} {}", range.max_excluded ? "below" : "at most", range.max);
  }
  if (!field.unit.empty()) text += fmt::format(" {}", field.unit);
  return text;
}

bool is_numeric(const SpecField& field) {
  return !std::holds_alternative<std::monostate>(field.access) &&
         (field.kind == FieldKind::number || field.kind == FieldKind::optional_number ||
          field.kind == FieldKind::integer || field.kind == FieldKind::efficiency);
}

void set_field(Design& design, const SpecField& field, double value) {
  // Sweeps come here millions of times: texts are made only for messages.
  if (!is_numeric(field)) throw std::invalid_argument(dot_path(field.pointer) + " takes no number");
  if (!field.range.contains(value)) {
    throw std::invalid_argument(fmt::format("{} = {} is not allowed: it must be {}",
                                            dot_path(field.pointer), value, describe_range(field)));
  }
  const double si = value * field.si_factor;
  if (const auto* number = std::get_if<Access<double>>(&field.access)) {
    (*number)(design) = si;
    if (&(*number)(design) == &design.drone.mass) renew_drag_estimate(design.drone);
  } else if (const auto* optional = std::get_if<Access<std::optional<double>>>(&field.access)) {
    (*optional)(design) = si;
  } else if (const auto* integer = std::get_if<Access<int>>(&field.access)) {
    if (value != std::floor(value)) {
      throw std::invalid_argument(fmt::format("{} = {} is not allowed: it must be a whole number",
                                              dot_path(field.pointer), value));
    }
    (*integer)(design) = static_cast<int>(value);
  } else if (const auto* converter = std::get_if<Access<Converter>>(&field.access)) {
    (*converter)(design).efficiency = {{0.0, value}};
  }
}

std::optional<double> field_value(const Design& design, const SpecField& field) {
  const auto si = field_value_si(design, field);
  return si ? std::optional(*si / field.si_factor) : std::nullopt;
}

std::optional<double> field_value_si(const Design& design, const SpecField& field) {
  if (!is_numeric(field)) return std::nullopt;
  auto& lent = const_cast<Design&>(design);  // the table's accessors could write; here none does
  if (const auto* number = std::get_if<Access<double>>(&field.access)) {
    const double value = (*number)(lent);
    const bool unset = field.kind == FieldKind::optional_number && value == 0;
    return unset ? std::nullopt : std::optional(value);
  }
  if (const auto* optional = std::get_if<Access<std::optional<double>>>(&field.access)) {
    return (*optional)(lent);
  }
  if (const auto* integer = std::get_if<Access<int>>(&field.access)) return (*integer)(lent);
  const auto& curve = std::get<Access<Converter>>(field.access)(lent).efficiency;
  return curve.size() == 1 ? std::optional(curve.front().efficiency) : std::nullopt;
}

std::span<const std::string> field_words(FieldKind kind) {
  static const std::array<std::string, 2> booleans{"false", "true"};
  static const std::array<std::string, 2> conditions{"hover", "forward"};
  static const std::array<std::string, 3> fibres{"none", "aramid", "uhmwpe"};
  static const std::array<std::string, 2> models{"straight", "solved"};
  static const std::array<std::string, 3> profiles{"uniform", "power_law", "logarithmic"};
  if (kind == FieldKind::boolean) return booleans;
  if (kind == FieldKind::condition) return conditions;
  if (kind == FieldKind::strength_material) return fibres;
  if (kind == FieldKind::tether_model) return models;
  if (kind == FieldKind::wind_profile) return profiles;
  return {};
}

namespace {

/// Calls `use` with the boolean or the choice where a field with words lives.
template <class Use>
void with_word(Design& design, const SpecField& field, const Use& use) {
  const auto call = [&]<class Access>(const Access& access) {
    if constexpr (!std::is_same_v<Access, std::monostate>) {
      using Value = std::remove_reference_t<decltype(access(design))>;
      if constexpr (std::is_same_v<Value, bool> || std::is_enum_v<Value>) use(access(design));
    }
  };
  std::visit(call, field.access);
}

}  // namespace

std::size_t field_word(const Design& design, const SpecField& field) {
  std::size_t index = 0;
  with_word(const_cast<Design&>(design), field,  // as above
            [&](const auto& value) { index = static_cast<std::size_t>(value); });
  return index;
}

void set_word(Design& design, const SpecField& field, std::size_t index) {
  with_word(design, field, [&]<class Value>(Value& value) { value = static_cast<Value>(index); });
}

bool may_conflict(std::string_view path) {
  // All that `find_conflicts` looks at; of what is meant with these names no field else is.
  constexpr std::array looked_at{"supply.",
                                 "tether.length_m",
                                 "tether.insulation.",
                                 "tether.cover.width_mm",
                                 "tether.drum.",
                                 "tether.strength_member.",
                                 "tether.model",
                                 "tether.drag_by_reynolds_number",
                                 "flight.horizontal_offset_m",
                                 "flight.station_height_m",
                                 "flight.wind_profile",
                                 "flight.wind_reference_height_m",
                                 "flight.roughness_length_m"};
  return std::ranges::any_of(looked_at,
                             [&](std::string_view start) { return path.starts_with(start); });
}

std::optional<std::string> roughness_conflict(WindProfile profile, double roughness_length,
                                              double known_at) {
  if (profile != WindProfile::logarithmic || roughness_length < known_at) return std::nullopt;
  return fmt::format("{} m is not less than the {} m over ground at which the wind is known",
                     roughness_length, known_at);
}

std::vector<FieldConflict> find_conflicts(const Design& design) {
  std::vector<FieldConflict> conflicts;
  const Converter& converter = design.supply.converter;
  if (converter.max_input_voltage && *converter.max_input_voltage < design.supply.voltage) {
    conflicts.push_back({"/supply/converter/max_input_voltage_V",
                         fmt::format("the converter stands {} V at its input, but the supply gives "
                                     "{} V, which is what arrives when no current flows",
                                     *converter.max_input_voltage, design.supply.voltage)});
  }
  if (converter.min_input_voltage >= design.supply.voltage) {
    conflicts.push_back({"/supply/converter/min_input_voltage_V",
                         fmt::format("the converter cuts off below {} V, but the supply gives only "
                                     "{} V; the supply voltage must be the higher one",
                                     converter.min_input_voltage, design.supply.voltage)});
  }
  if (converter.min_input_voltage < design.supply.voltage &&
      lowest_input_voltage(converter) >= design.supply.voltage) {
    conflicts.push_back({"/supply/converter/min_output_voltage_V",
                         fmt::format("behind the fixed ratio of {} even the supply's {} V make "
                                     "only {} V, and the motors need {} V",
                                     *converter.fixed_ratio, design.supply.voltage,
                                     *converter.fixed_ratio * design.supply.voltage,
                                     converter.min_output_voltage)});
  }
  if (!converter.fixed_ratio && converter.min_output_voltage > 0) {
    conflicts.push_back({"/supply/converter/min_output_voltage_V",
                         "is for converters whose output follows their input; give fixed_ratio"});
  }
  if (!converter.rated_output_power && (converter.specific_mass > 0 || !converter.masses.empty())) {
    conflicts.push_back({converter.masses.empty() ? "/supply/converter/specific_mass_kg_per_kW"
                                                  : "/supply/converter/mass_table",
                         "the converter's mass follows from its rated output, which is not known; "
                         "give rated_output_W"});
  }
  if (converter.specific_mass > 0 && !converter.masses.empty()) {
    conflicts.push_back(
        {"/supply/converter/mass_table",
         "and specific_mass_kg_per_kW both give the converter's mass; only one can be right"});
  }
  const Drum& drum = design.tether.drum;
  if ((drum.core_diameter > 0) != (drum.width > 0)) {
    conflicts.push_back({drum.width > 0 ? "/tether/drum/core_diameter_mm" : "/tether/drum/width_mm",
                         "a wound package has both a core's diameter and a width; give this too"});
  }
  const Tether& tether = design.tether;
  const double turn =
      wound_side(tether, 0, insulation_wall(tether.insulation, design.supply.voltage));
  if (drum.width > 0 && drum.width <= turn) {
    conflicts.push_back(
        {"/tether/drum/width_mm",
         fmt::format(
             "the {:.4g} mm between the flanges hold no turn of a tether that takes {:.4g} mm even "
             "without its conductors",
             drum.width / unit::millimetre, turn / unit::millimetre)});
  }
  const Insulation& insulation = design.tether.insulation;
  if (insulation.dielectric_safety_factor > 0 && !(insulation.breakdown_strength > 0)) {
    conflicts.push_back(
        {"/tether/insulation/dielectric_safety_factor",
         "asks for a wall by the voltage, but the breakdown strength of the insulation material is "
         "not known; give a material that has breakdown_kV_mm"});
  }
  const Flight& flight = design.flight;
  if (flight.horizontal_offset > 0 && design.tether.model == TetherModel::straight) {
    conflicts.push_back({"/flight/horizontal_offset_m",
                         "a straight tether hangs down from the drone; give tether.model solved"});
  }
  if (design.tether.drag_by_reynolds_number && design.tether.model == TetherModel::straight) {
    conflicts.push_back({"/tether/drag_by_reynolds_number",
                         "the straight tether has one drag coefficient at all speeds; give "
                         "tether.model solved"});
  }
  const double known_at =
      flight.wind_reference_height.value_or(flight.station_height + design.tether.length);
  if (auto rough = roughness_conflict(flight.wind_profile, flight.roughness_length, known_at)) {
    conflicts.push_back({"/flight/roughness_length_m", std::move(*rough)});
  }
  try {
    validate(converter);
  } catch (const std::invalid_argument& error) {
    conflicts.push_back({"/supply/converter/efficiency", error.what()});
  }
  return conflicts;
}

}  // namespace tethercalc
