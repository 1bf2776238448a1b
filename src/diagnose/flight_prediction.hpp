// The horizontal acceleration that attitude, speed and drag make us expect, effect by effect.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/airframe.hpp"

namespace tethercalc {

/// What a prediction of a flight may use: attitude, speed over ground, and time. The horizontal
/// acceleration is not here, so no effect can be built from what it should explain. One element a
/// sample, in the stabilised frame of `Observations`, SI units.
struct FlightRecord {
  std::vector<double> time;      ///< s
  std::vector<double> tilt;      ///< θ, positive leaning forward
  std::vector<double> tan_tilt;  ///< tan θ
  std::vector<double> cos_tilt;  ///< cos θ
  std::vector<double> yaw;       ///< rad
  /// Cosine and sine of the yaw less the mean heading of the flight, of which this may be a part:
  /// how far forward is along that heading, and how far to its right.
  std::vector<double> along_heading;
  std::vector<double> right_of_heading;
  /// m from the mean place of the flight, along the mean heading and to the right of it: the speed
  /// over ground, added up. As exact as that: an error of 0.1 m/s for a minute is 6 m.
  std::vector<double> place_along;
  std::vector<double> place_right;
  std::vector<double> height;         ///< m above the first sample, likewise
  std::vector<double> forward_speed;  ///< m/s over ground
  std::vector<double> right_speed;    ///< m/s over ground
  std::vector<double> headwind;    ///< m/s along the forward axis, as measured; 0 where it was not
  std::vector<double> crosswind;   ///< to the right, likewise
  std::vector<double> down_speed;  ///< m/s
  std::vector<double> down_acceleration;  ///< m/s²
  std::vector<double> sideward_thrust;  ///< tan φ/cos θ: of what the thrust carries, to the right
  std::vector<double> cos_sideward;     ///< of the lean to the side, whose tangent that is
  std::vector<double> yaw_rate;         ///< rad/s
  double mean_heading = 0;              ///< rad in (−π, π], of the whole flight
  double mean_height = 0;               ///< m, likewise
  double mass = 0;                      ///< kg
  double air_density = 0;               ///< kg/m³
  double gravity = 0;                   ///< m/s²
  double middle_time = 0;               ///< s, halfway through the whole flight
  double duration = 0;                  ///< s, of the whole flight
  /// Whether the acceleration to the right is predicted too (`shows_both_axes`, or where the
  /// heading is off, since one axis takes that for another speed). Then a wind from the side shows
  /// there; else none is told.
  bool both_axes = false;

  /// Number of samples.
  [[nodiscard]] std::size_t size() const { return time.size(); }
};

/// By axes that turn with the drone.
struct AtDrone {
  double forward = 0;
  double right = 0;
};
/// Along the mean heading of the flight and to its right.
struct OverGround {
  double along = 0;
  double right = 0;
};
/// The same in sample `i` by the other axes.
[[nodiscard]] AtDrone at_drone(const FlightRecord& record, std::size_t i, const OverGround& x);
[[nodiscard]] OverGround over_ground(const FlightRecord& record, std::size_t i, const AtDrone& x);

/// Where a flight went between two samples, in m, other than straight on.
struct Detour {
  double begin = 0;  ///< s, the time of the sample before
  double end = 0;    ///< s, of the sample after
  double north = 0;
  double east = 0;
  double up = 0;
};

/// `mass` kg > 0, `air_density` kg/m³ > 0, `gravity` m/s² > 0.
[[nodiscard]] FlightRecord flight_record(const Observations& observations, double mass,
                                         double air_density, double gravity,
                                         std::span<const Detour> detours = {});

/// Parameters that every drag flight needs and that are no effects.
struct FlightBase {
  double front_area = 0;  ///< A_f, m²
  double top_area = 0;    ///< A_t, m²
  double side_area = 0;   ///< A_s, m²: what the front area is forward, to the side
  /// Part of the logged vertical acceleration that the flight follows. The derivative of a logged
  /// velocity is noisy; the least-squares slope of a noisy regressor is its reliability, below 1
  /// (Fuller, Measurement Error Models, 1987, section 1.1). Left at 1, its noise times tan θ would
  /// enter every prediction.
  double vertical_acceleration_gain = 1;
  /// Part of the measured wind's changes that the drag follows. The sensor is beside the
  /// propellers, and noisy; of its mean the effect `wind` tells how wrong it is.
  double wind_gain = 0;
  /// rad, what the roll reads while the thrust points neither left nor right: of no interest, but
  /// always there a little.
  double roll_trim = 0;
};

/// What the samples of a phase were made from: as long as nothing of it changes they stay.
struct MadeFrom {
  std::vector<const Effect*> effects;
  std::vector<double> numbers;  ///< of the base, and of the effects

  bool operator==(const MadeFrom&) const = default;
};

/// The thrust's direction, one element a sample.
struct ThrustDirection {
  MadeFrom from;
  std::vector<double> tilt;      ///< θ as the thrust had it, from which attitude effects start
  std::vector<double> tan_tilt;  ///< of `tilt`; known after the attitude phase
  std::vector<double> cos_tilt;  ///< of `tilt`; known after the attitude phase
  /// tan φ/cos θ as the thrust had it, from which attitude effects start.
  std::vector<double> sideward;
  std::vector<double> cos_sideward;  ///< of the lean to the side; known after the attitude phase
};

/// A prediction in the making. The catalogue's effects work on it in the phases of `FlightPhase`;
/// each vector holds one element a sample. It may be made anew with other values: a phase whose
/// effects and parameters are as before is not done again, so the record must stay as it is.
struct FlightPrediction {
  const FlightRecord& record;  ///< what is predicted from
  ThrustDirection thrust;
  /// Of the values before: derivatives are taken by going away from a point and back to it.
  ThrustDirection thrust_before;
  MadeFrom air_from;
  std::vector<double> headwind;  ///< w along the forward axis, m/s: airspeed is forward speed − w
  std::vector<double> aside;     ///< m/s, the airspeed to the right
  AirframeDrag law;              ///< of the drag
  double side_area = 0;          ///< m², in place of the law's front area to the side
  std::vector<double> airspeed;  ///< m/s, forward positive; known in the force phase
  std::vector<double> law_drag;  ///< N by the law alone; known in the force phase
  std::vector<double> law_side_drag;  ///< N likewise, to the right
  std::vector<double> drag;           ///< N against the motion; known in the force phase
  std::vector<double> side_drag;  ///< N against the motion to the right; known in the force phase
  std::vector<double> lift;       ///< m/s², what the thrust carries; known in the force phase
  std::vector<double> acceleration;       ///< m/s² forward at each sample: the result
  std::vector<double> side_acceleration;  ///< m/s² to the right, likewise; 0 without both axes

  /// Sized for `flight`, which must outlive it.
  explicit FlightPrediction(const FlightRecord& flight);
};

/// An effect with values for its parameters, in SI.
struct EffectValues {
  const Effect* effect = nullptr;  ///< never null
  std::span<const double> values;  ///< one a parameter
};

/// Fills `prediction.acceleration` = (g − κ·a_D)·tanθ − F_D/m with F_D the forward part of the drag
/// (`airframe_drag_along`) at the airspeed v − w, as changed by `effects`, and with both axes
/// `prediction.side_acceleration` = (g − κ·a_D)·tanφ/cosθ − F_S/m alike, of the velocity over
/// ground, which the turning of the nose does not change. A thrust along the body's z-axis turned
/// by yaw, pitch and roll in this order points so, exactly; the published 1/cos φ is not in it.
/// Where the acceleration to the right is not predicted, the airspeed there is the speed over
/// ground, less a measured wind: a crosswind that is fitted mimics linear drag, since both drag in
/// proportion to a small speed forward. Effects act in the order given within each phase; those at
/// their neutral values change nothing.
void predict_acceleration(FlightPrediction& prediction, const FlightBase& base,
                          std::span<const EffectValues> effects);

/// The air in sample `i` moves by `along` m/s in the direction of the mean heading and by `right`
/// to its right, beside what it does already.
void blow(FlightPrediction& prediction, std::size_t i, double along, double right);
/// A force in N pulls likewise.
void pull(FlightPrediction& prediction, std::size_t i, double along, double right);
/// As `blow`, by axes that turn with the drone.
void blow_at_drone(FlightPrediction& prediction, std::size_t i, double forward, double right);

/// N on the airframe alone, forward and to the right, against an airspeed in m/s so split.
struct DragForces {
  double forward = 0;
  double right = 0;
};
/// In sample `i`, by the law of the prediction.
[[nodiscard]] inline DragForces law_drag(const FlightPrediction& prediction, std::size_t i,
                                         double forward, double right) {
  const FlightPrediction& p = prediction;
  const double density = p.record.air_density;
  // To both sides alike.
  const AirframeDrag sideward{p.side_area, p.law.top_area, p.law.linear_speed, 0};
  return {airframe_drag_along(p.law, density, forward, right,
                              effective_area(p.law, p.thrust.tan_tilt[i], p.thrust.cos_tilt[i])),
          airframe_drag_along(
              sideward, density, right, forward,
              effective_area(sideward, p.thrust.sideward[i], p.thrust.cos_sideward[i]))};
}

/// Samples first ≤ i < last of a flight.
[[nodiscard]] FlightRecord part_of(const FlightRecord& record, std::size_t first, std::size_t last);

/// The forward speed simulated in open loop: at the start of every window the logged one, from
/// there on integrated from the predicted acceleration (trapezoids), with drag following the
/// simulated speed and attitude the logged one. Windows of `window` s, one after the other; a
/// window also ends where the log has a step of more than `longest_step` s. m/s, one element a
/// sample.
[[nodiscard]] std::vector<double> simulate_speed(const FlightRecord& record, const FlightBase& base,
                                                 std::span<const EffectValues> effects,
                                                 double window, double longest_step);

}  // namespace tethercalc
