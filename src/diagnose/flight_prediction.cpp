// Notation: θ tilt, u airspeed, w headwind along the forward axis, j linear speed of the
// drag law, κ gain of the vertical acceleration a_D.
#include "diagnose/flight_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "identify/flight_units.hpp"
#include "identify/linear_algebra.hpp"

namespace tethercalc {
namespace {

void act(FlightPrediction& prediction, std::span<const EffectValues> effects, FlightPhase phase) {
  for (const EffectValues& e : effects) {
    if (e.effect->flight_phase == phase) e.effect->on_flight(prediction, e.values);
  }
}

/// Picard iterations of the open-loop speed. The error shrinks like (λT)^n/n!, with λ ≈ 0.4 1/s for
/// the damping of a small drone at 20 m/s and T = 5 s: 2^16/16! is 3e-9.
constexpr int picard_iterations = 16;

void set_cosines(const std::vector<double>& tangent, std::vector<double>& cosine) {
  as_series(cosine) = (1 + as_series(tangent).square()).sqrt().inverse();
}

/// The effects of a phase with their values, and numbers beside them.
MadeFrom made_from(std::span<const EffectValues> effects, FlightPhase phase,
                   std::vector<double> numbers) {
  MadeFrom from{{}, std::move(numbers)};
  for (const EffectValues& e : effects) {
    if (e.effect->flight_phase != phase) continue;
    from.effects.push_back(e.effect);
    from.numbers.insert(from.numbers.end(), e.values.begin(), e.values.end());
  }
  return from;
}

/// The attitude phase.
void direct_thrust(FlightPrediction& p, const FlightBase& base,
                   std::span<const EffectValues> effects) {
  MadeFrom from = made_from(effects, FlightPhase::attitude, {base.roll_trim});
  if (p.thrust.from == from) return;
  std::swap(p.thrust, p.thrust_before);
  if (p.thrust.from == from) return;

  const FlightRecord& record = p.record;
  ThrustDirection& thrust = p.thrust;
  thrust.from = std::move(from);
  thrust.tilt = record.tilt;
  thrust.tan_tilt = record.tan_tilt;
  thrust.cos_tilt = record.cos_tilt;
  thrust.sideward = record.sideward_thrust;
  thrust.cos_sideward = record.cos_sideward;
  act(p, effects, FlightPhase::attitude);
  if (thrust.tilt != record.tilt) {
    std::transform(thrust.tilt.begin(), thrust.tilt.end(), thrust.tan_tilt.begin(),
                   [](double tilt) { return std::tan(tilt); });
    set_cosines(thrust.tan_tilt, thrust.cos_tilt);
  }
  if (base.roll_trim != 0) {
    for (double& sideward : thrust.sideward) sideward -= base.roll_trim;
  }
  if (thrust.sideward != record.sideward_thrust) {
    set_cosines(thrust.sideward, thrust.cos_sideward);
  }
}

/// The air phase, and the drag by the law.
void meet_air(FlightPrediction& p, const FlightBase& base, std::span<const EffectValues> effects) {
  MadeFrom from = made_from(effects, FlightPhase::air,
                            {base.wind_gain, base.front_area, base.top_area, base.side_area});
  const MadeFrom& thrust = p.thrust.from;
  from.effects.insert(from.effects.end(), thrust.effects.begin(), thrust.effects.end());
  from.numbers.insert(from.numbers.end(), thrust.numbers.begin(), thrust.numbers.end());
  if (p.air_from == from) return;
  p.air_from = std::move(from);

  const FlightRecord& record = p.record;
  for (std::size_t i = 0; i < record.size(); ++i) {
    p.headwind[i] = base.wind_gain * record.headwind[i];
    p.aside[i] = record.right_speed[i] - base.wind_gain * record.crosswind[i];
  }
  p.law = {base.front_area, base.top_area, 0, 0};
  p.side_area = base.side_area;
  act(p, effects, FlightPhase::air);
  for (std::size_t i = 0; i < record.size(); ++i) {
    p.airspeed[i] = record.forward_speed[i] - p.headwind[i];
    const DragForces drag = law_drag(p, i, p.airspeed[i], p.aside[i]);
    p.law_drag[i] = drag.forward;
    p.law_side_drag[i] = drag.right;
  }
}

/// A speed added up from the first sample on.
std::vector<double> added_up(const std::vector<double>& time, const std::vector<double>& speed) {
  std::vector<double> place(speed.size(), 0.0);
  for (std::size_t i = 1; i < speed.size(); ++i) {
    place[i] = place[i - 1] + (speed[i - 1] + speed[i]) / 2 * (time[i] - time[i - 1]);
  }
  return place;
}

/// Moves all from sample `i` on to where `way` leads from the sample before.
void go(std::vector<double>& place, std::size_t i, double way) {
  const double more = place[i - 1] + way - place[i];
  for (; i < place.size(); ++i) place[i] += more;
}

double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

void take_off_mean(std::vector<double>& x) {
  const double mean = mean_of(x);
  for (double& value : x) value -= mean;
}

/// Fills `place_along`, `place_right` and `height`.
void add_places(FlightRecord& record, std::span<const Detour> detours) {
  std::vector<double> along(record.size());
  std::vector<double> right(record.size());
  std::vector<double> up(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    const OverGround speed =
        over_ground(record, i, {record.forward_speed[i], record.right_speed[i]});
    along[i] = speed.along;
    right[i] = speed.right;
    up[i] = -record.down_speed[i];
  }
  record.place_along = added_up(record.time, along);
  record.place_right = added_up(record.time, right);
  record.height = added_up(record.time, up);
  const double c = std::cos(record.mean_heading);
  const double s = std::sin(record.mean_heading);
  for (const Detour& d : detours) {
    const auto after = std::ranges::upper_bound(record.time, (d.begin + d.end) / 2);
    if (after == record.time.begin() || after == record.time.end()) continue;
    const auto i = static_cast<std::size_t>(after - record.time.begin());
    go(record.place_along, i, d.north * c + d.east * s);
    go(record.place_right, i, d.east * c - d.north * s);
    go(record.height, i, d.up);
  }
  take_off_mean(record.place_along);
  take_off_mean(record.place_right);
  if (record.size() > 0) record.mean_height = mean_of(record.height);
}

}  // namespace

AtDrone at_drone(const FlightRecord& record, std::size_t i, const OverGround& x) {
  const double c = record.along_heading[i];
  const double s = record.right_of_heading[i];
  return {x.along * c + x.right * s, x.right * c - x.along * s};
}

OverGround over_ground(const FlightRecord& record, std::size_t i, const AtDrone& x) {
  const double c = record.along_heading[i];
  const double s = record.right_of_heading[i];
  return {x.forward * c - x.right * s, x.forward * s + x.right * c};
}

FlightRecord flight_record(const Observations& observations, double mass, double air_density,
                           double gravity, std::span<const Detour> detours) {
  FlightRecord record;
  record.time = observations.time;
  record.tilt = observations.tilt;
  record.yaw = observations.yaw;
  record.forward_speed = observations.forward_speed;
  record.right_speed = observations.right_speed;
  record.down_speed = observations.down_speed;
  record.headwind = observations.forward_wind;
  record.crosswind = observations.right_wind;
  record.headwind.resize(observations.size(), 0.0);
  record.crosswind.resize(observations.size(), 0.0);
  record.down_acceleration = observations.down_acceleration;
  record.tan_tilt.reserve(observations.size());
  record.cos_tilt.reserve(observations.size());
  for (const double tilt : observations.tilt) {
    record.tan_tilt.push_back(std::tan(tilt));
    record.cos_tilt.push_back(std::cos(tilt));
  }
  record.sideward_thrust.reserve(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    record.sideward_thrust.push_back(std::tan(observations.roll[i]) /
                                     std::cos(observations.tilt[i]));
  }
  record.cos_sideward.resize(observations.size());
  set_cosines(record.sideward_thrust, record.cos_sideward);
  record.mean_heading = mean_heading(observations);
  for (const double yaw : observations.yaw) {
    record.along_heading.push_back(std::cos(yaw - record.mean_heading));
    record.right_of_heading.push_back(std::sin(yaw - record.mean_heading));
  }
  add_places(record, detours);
  record.yaw_rate = yaw_rate(observations);
  record.both_axes =
      shows_both_axes(observations, gravity) || heading_error(observations, gravity).has_value();
  record.mass = mass;
  record.air_density = air_density;
  record.gravity = gravity;
  if (record.size() > 0) {
    record.middle_time = (record.time.front() + record.time.back()) / 2;
    record.duration = record.time.back() - record.time.front();
  }
  return record;
}

FlightRecord part_of(const FlightRecord& record, std::size_t first, std::size_t last) {
  FlightRecord part = record;
  for (auto series :
       {&FlightRecord::time, &FlightRecord::tilt, &FlightRecord::tan_tilt, &FlightRecord::cos_tilt,
        &FlightRecord::yaw, &FlightRecord::along_heading, &FlightRecord::right_of_heading,
        &FlightRecord::place_along, &FlightRecord::place_right, &FlightRecord::height,
        &FlightRecord::forward_speed, &FlightRecord::right_speed, &FlightRecord::headwind,
        &FlightRecord::crosswind, &FlightRecord::down_speed, &FlightRecord::down_acceleration,
        &FlightRecord::sideward_thrust, &FlightRecord::cos_sideward, &FlightRecord::yaw_rate}) {
    const auto begin = (record.*series).begin();
    (part.*series)
        .assign(begin + static_cast<std::ptrdiff_t>(first),
                begin + static_cast<std::ptrdiff_t>(last));
  }
  return part;
}

FlightPrediction::FlightPrediction(const FlightRecord& flight)
    : record(flight),
      headwind(flight.size()),
      aside(flight.size()),
      airspeed(flight.size()),
      law_drag(flight.size()),
      law_side_drag(flight.size()),
      lift(flight.size()),
      acceleration(flight.size()),
      side_acceleration(flight.size()) {}

void blow_at_drone(FlightPrediction& p, std::size_t i, double forward, double right) {
  p.headwind[i] += forward;
  if (p.record.both_axes) p.aside[i] -= right;
}

void blow(FlightPrediction& p, std::size_t i, double along, double right) {
  const AtDrone wind = at_drone(p.record, i, {along, right});
  blow_at_drone(p, i, wind.forward, wind.right);
}

void pull(FlightPrediction& p, std::size_t i, double along, double right) {
  const AtDrone force = at_drone(p.record, i, {along, right});
  p.drag[i] -= force.forward;
  p.side_drag[i] -= force.right;
}

void predict_acceleration(FlightPrediction& p, const FlightBase& base,
                          std::span<const EffectValues> effects) {
  direct_thrust(p, base, effects);
  meet_air(p, base, effects);

  const FlightRecord& record = p.record;
  as_series(p.lift) =
      record.gravity - base.vertical_acceleration_gain * as_series(record.down_acceleration);
  p.drag = p.law_drag;
  p.side_drag = p.law_side_drag;
  act(p, effects, FlightPhase::force);

  as_series(p.acceleration) =
      as_series(p.lift) * as_series(p.thrust.tan_tilt) - as_series(p.drag) / record.mass;
  as_series(p.side_acceleration) =
      as_series(p.lift) * as_series(p.thrust.sideward) - as_series(p.side_drag) / record.mass;
  act(p, effects, FlightPhase::reading);
}

std::vector<double> simulate_speed(const FlightRecord& record, const FlightBase& base,
                                   std::span<const EffectValues> effects, double window,
                                   double longest_step) {
  FlightRecord simulated = record;
  for (int iteration = 0; iteration < picard_iterations; ++iteration) {
    FlightPrediction prediction(simulated);
    predict_acceleration(prediction, base, effects);
    std::vector<double>& a = prediction.acceleration;
    // The nose turns into what flies to the side.
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += record.yaw_rate[i] * record.right_speed[i];
    std::vector<double>& v = simulated.forward_speed;
    double window_start = record.size() > 0 ? record.time.front() : 0;
    for (std::size_t i = 1; i < record.size(); ++i) {
      const double step = record.time[i] - record.time[i - 1];
      if (record.time[i] - window_start >= window || step > longest_step) {
        window_start = record.time[i];
        v[i] = record.forward_speed[i];
      } else {
        v[i] = v[i - 1] + (a[i - 1] + a[i]) / 2 * step;
      }
    }
  }
  return simulated.forward_speed;
}

}  // namespace tethercalc
