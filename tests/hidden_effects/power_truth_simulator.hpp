// A tethered drone that flies with known hidden effects and writes the power log its instruments
// would. Shares no code with the library: its own motor table, balance of forces, line and
// converter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace power_truth {

/// What is hidden from the spec; every default hides nothing. SI units.
struct HiddenEffects {
  double resistivity_factor = 1;
  double heating = 0;  ///< K per W/m of loop in still air, conductor at ambient + rise
  double heating_time_constant = 200;  ///< s
  double heating_wind_cooling = 0.2;   ///< rise divided by 1 + c·√(v in m/s)
  double contact_resistance = 0;       ///< Ω
  double spooled_length = -1;  ///< m beyond 30 m on a drum that holds all that is not airborne;
                               ///< negative: no drum
  double converter_fixed_loss = 0;         ///< W; > 0 replaces the constant efficiency by
                                           ///< input = output + fixed + ratio·output²
  double converter_square_loss = 1.55e-4;  ///< 1/W
  double auxiliary_power = 0;  ///< W at the converter's input, on top of the spec's 15 W
  double extra_mass = 0;       ///< kg
  double motor_power_factor = 1;
  double translational_lift = 0;  ///< share of hover power that is induced and falls off
  double induced_speed = 6;       ///< m/s, induced velocity in hover
  double tether_drag_factor = 1;
  double airframe_drag_factor = 1;
  double slack = 0;               ///< cable in the air over the height, beside the rig's
  double winch_pull = 0;          ///< N, beside the rig's
  double motor_power_growth = 0;  ///< relative, steadily over the log
  double air_density_factor = 1;  ///< truth over the spec's
  double payload_drop = 0;        ///< kg, from `step_at` on
  double air_share = 0;           ///< of the way from 20 °C to the air's: the cable's temperature
  double colder_air = 0;          ///< K below the scenario's, in the log as well
  double climb_work = 0;          ///< W at the bus over weight times climbing speed

  // What instruments make of the truth.
  double supply_current_gain = 1;    ///< reading over truth
  double supply_current_offset = 0;  ///< A
  double supply_voltage_gain = 1;    ///< reading over truth
  double drone_voltage_offset = 0;   ///< V
  double bus_current_gain = 1;       ///< reading over truth
  double height_bias = 0;            ///< m
  double airspeed_gain = 1;          ///< reading over truth

  double step_at = 0.6;  ///< part of the log after which what happens at once has happened

  // Not in anybody's catalogue.
  double step_in_motor_power = 0;     ///< relative, from `step_at` of the log on
  double motor_power_per_height = 0;  ///< relative at 30 m, growing with the square of the height
  double step_in_resistance = 0;      ///< Ω, from `step_at` on
  double motor_power_swing = 0;       ///< relative amplitude of a slow wave in time, period 600 s
};

/// The drone and the tether that fly, as the spec has them. The default is a Holybro X500 on 30 m
/// of aluminium at 75 V.
struct Rig {
  double mass = 1.71;          ///< kg
  double voltage = 75;         ///< V at the ground
  double length = 30;          ///< m, as high as it flies
  double area = 1.09e-6;       ///< m²
  double efficiency = 0.9;     ///< of the converter
  double auxiliaries = 15;     ///< W
  double motor_size = 1;       ///< thrust and power of the data sheet are multiplied with it
  double drag_scale = 1;       ///< of the airframe's areas
  double air_density = 1.293;  ///< kg/m³

  /// How the cable hangs: straight down; or as weight and wind shape it, paid out so much beyond
  /// the height, or as the winch's pull takes it.
  enum class Cable { straight, slack, winch } cable = Cable::straight;
  double slack = 0;       ///< of the height
  double winch_pull = 0;  ///< N
};

enum class Profile {
  plateaus,    ///< 5 … 30 m, airspeed 0 … 9 m/s in steps
  one_height,  ///< 15 m throughout, airspeed as above
};

struct Scenario {
  HiddenEffects hidden;
  Rig rig;
  Profile profile = Profile::plateaus;
  double duration = 0;             ///< s; 0: about 1,550
  double sample_interval = 1;      ///< s
  double ambient_temperature = 0;  ///< °C; 0: drawn between 17 and 22
  std::uint64_t seed = 1;

  double instrument_noise = 1;  ///< all standard deviations are multiplied with it
  double deviation = 0.012;     ///< of the motor power, relative

  /// Flown instead of the profile, one element a sample; the hidden mass is in the thrust already.
  struct Track {
    std::vector<double> height;    ///< m
    std::vector<double> airspeed;  ///< m/s
    std::vector<double> thrust;    ///< N, of all motors
    std::vector<double> tilt;      ///< rad, of their discs
  };
  Track track{};

  // Bad instruments.
  double bus_clock_offset = 0;     ///< s: bus readings are stamped this much late
  double flight_clock_offset = 0;  ///< s: height and airspeed are stamped this much late
  double outlier_share = 0;        ///< of the samples of every channel
  std::string stuck_channel;       ///< CSV name; holds its value over the middle third
};

/// Columns of a power log, named as in the CSV without units.
struct Log {
  std::vector<double> time, height, airspeed, ambient_temperature, supply_voltage, supply_current,
      drone_voltage, bus_voltage, bus_current;
};

/// kg of the cable in the air, and m² that its drag is ½·ρ·v² of.
struct Cable {
  double mass = 0;
  double drag_area = 0;
};
[[nodiscard]] Cable cable_at(const Rig& rig, double height);

/// Deterministic in the scenario. Airspeed gusts by 0.3 m/s (first-order autoregressive, 0.85 at
/// 1 Hz), motor power deviates by 1.2 % (0.79 at 1 Hz); every instrument adds white noise and
/// rounds.
[[nodiscard]] Log simulate(const Scenario& scenario);

}  // namespace power_truth
