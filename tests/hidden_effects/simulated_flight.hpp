// A drone flown through the air by its own equations of motion, and the log it would leave behind:
// the truth that diagnoses are judged by. Shares no code with the library beyond the log's
// container.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc::truth {

/// How the pilot flies.
enum class Pattern {
  passes,        ///< to and fro without end
  hover_first,   ///< hover for a third of the flight, then passes
  long_forward,  ///< long stretches forward at a few tilts, seldom backward
  circles,       ///< passes while the yaw turns steadily, once a minute
};

/// Commanded by an autopilot: the nose turns first, then the drone moves, then it hovers.
struct Leg {
  double heading = 0;  ///< rad, of the nose, clockwise from north
  double ahead = 0;    ///< m along the nose
  double aside = 0;    ///< m to its right
  double climb = 0;    ///< m
  double speed = 1;    ///< m/s over ground at most
  double hold = 0;     ///< s
};

/// What is true of a flight. Effects that are hidden in it have values other than zero.
struct HiddenFlight {
  std::uint64_t seed = 1;
  double duration = 540;  ///< s
  double mass = 1.8;      ///< kg
  double air_density = 1.225;
  double front_area = 0.017;  ///< m²
  double top_area = 0.016;
  double linear = 15;    ///< m/s
  double wind = -1;      ///< m/s along the forward axis
  double crosswind = 0;  ///< m/s to the right of it, felt where the roll moves the drone

  /// deg, > 0: the pilot also flies passes to the side with rolls up to this, and the drone moves
  /// there as forward: thrust, gusts, and drag along the airspeed vector. Else the roll wanders
  /// and moves nothing.
  double steepest_roll = 0;
  double side_area = 0.02;  ///< m², of the drag to the side
  double tether_area = 0;   ///< m², of a cable that drags with the square of the airspeed alone
  double roll_trim = 0;     ///< deg, logged minus true roll

  /// Gusts: acceleration of a first-order process. These values leave residuals with a standard
  /// deviation of 0.17 m/s² and a lag-1 correlation of 0.86 at 10 Hz, as the real flight does.
  double gust_std = 0.17;      ///< m/s²
  double gust_time = 0.55;     ///< s
  double speed_noise = 0.004;  ///< m/s, white
  double angle_noise = 0.15;   ///< deg, white
  double roll_std = 2.0;       ///< deg
  bool yaw_turns = false;      ///< a new heading every 40 s
  Pattern pattern = Pattern::passes;
  /// Flown instead of the pattern, by an autopilot that also holds the track, however long that
  /// takes; the roll then moves the drone.
  std::vector<Leg> course{};
  double course_acceleration = 2.5;  ///< m/s², speeding up and braking
  double lateral_std = 0.35;         ///< m/s, speed to the right
  double gust_with_speed = 0;        ///< s/m: gusts grow by this part with each m/s of speed
  double pitch_drift = 0;            ///< deg, slow wave of the logged pitch, period 200 s
  double speed_digit = 0;            ///< m/s, speeds are rounded to this
  double steepest_pitch = 30;        ///< deg
  int steps_per_sample = 10;         ///< of 10 ms: 10 Hz
  /// m/s, white noise of an anemometer on board; 0: there is none.
  double anemometer_noise = 0;
  double climb = 0;  ///< m, a climb to this height and back every two minutes
  /// m/s, how fast it rises for each 1/cos θ − 1 of its lean, by a thrust that was not asked for.
  double rise_with_lean = 0;

  double attitude_delay = 0;  ///< s, attitude is logged this late
  double pitch_trim = 0;      ///< deg, logged minus true pitch
  double wind_north = 0;      ///< m/s, constant over ground
  double wind_east = 0;
  double wind_drift = 0;  ///< m/s from begin to end
  double fore_aft_asymmetry = 0;
  double propwash = 0;           ///< N·s/(m·rad)
  double vertical_coupling = 0;  ///< N·s²/m²
  // Along the first heading, and fixed over ground. A pull that grows is back to the station.
  double tether_pull = 0;         ///< N
  double growing_pull = 0;        ///< N for each m from the station
  double station = 0;             ///< m from the start, along the first heading
  double wind_step = 0;           ///< m/s, from 60 % of the flight on
  double wind_shear = 0;          ///< m/s for each m over the middle of the climb
  double wind_wave = 0;           ///< m/s, greatest in the middle of the flight
  double wind_wave_period = 160;  ///< s
  double mass_drop = 0;           ///< % of the mass, at 45 % of the flight
  double slung_load = 0;          ///< % of the mass, on a rope
  double rope = 2.5;              ///< m
  double swing_damping = 0.06;    ///< of the load, over the critical one
  /// deg, logged minus true heading. Other than zero, the drone is moved to the side by its roll.
  double yaw_misalign = 0;
  double velocity_lag = 0;    ///< s, of first order
  double velocity_scale = 1;  ///< logged over true

  // What the log is, whatever flew.
  double lost_rows = 0;     ///< part of the rows that are not in it, drawn one by one
  double gap = 0;           ///< s without a row, after 30 % of the flight
  double clock_jitter = 0;  ///< s, by so much at most a stamp is off; rows are taken evenly

  // Effects that no catalogue has.
  double roll_drag = 0;    ///< N·s/m: drag of u·(1 − cos φ)
  double step_force = 0;   ///< N forward from 45 % of the flight on
  double height_drag = 0;  ///< 1/m: drag grows by this part with each metre
};

/// What no log tells: one element for each second of a flight, the mean over it.
struct Flown {
  std::vector<double> airspeed;       ///< m/s
  std::vector<double> speeding_up;    ///< m/s², over ground, along the airspeed
  std::vector<double> turning_off;    ///< m/s², the rest of its root mean square
  std::vector<double> specific_lift;  ///< m/s², thrust over mass
};

/// Mass, drag and headwind of another drone on another day.
void draw_drone(HiddenFlight& hidden, std::mt19937_64& random);

/// From take-off to landing. Where `flown` is given it is filled, too.
[[nodiscard]] FlightLog fly(const HiddenFlight& hidden, Flown* flown = nullptr);

/// Replaces `part` of all pitch and forward-speed samples by values far off.
void add_outliers(FlightLog& log, double part, std::uint64_t seed);

}  // namespace tethercalc::truth
