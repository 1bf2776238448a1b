// The catalogue: one entry an effect. Adding an effect is adding an entry.
#include "tethercalc/diagnose/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <initializer_list>
#include <numbers>
#include <numeric>
#include <utility>

#include "diagnose/flight_prediction.hpp"
#include "diagnose/power_chain.hpp"
#include "identify/flight_units.hpp"
#include "model/constants.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

using Values = std::span<const double>;

/// The readings `delay` s later than each sample, by Lagrange's cubic through the four nearest
/// samples: a straight line between two would average their noise and so seem to explain something.
void shift(const std::vector<double>& time, double delay,
           std::initializer_list<std::vector<double>*> series) {
  const std::size_t size = time.size();
  if (size < 4) return;
  std::vector<std::size_t> first(size);
  std::vector<std::array<double, 4>> basis(size);
  std::size_t k = 0;  // time[k] is the last at or before the wanted time, as far as there is one
  for (std::size_t i = 0; i < size; ++i) {
    const double wanted = std::clamp(time[i] + delay, time.front(), time.back());
    while (k + 2 < size && time[k + 1] <= wanted) ++k;
    first[i] = std::min(k == 0 ? 0 : k - 1, size - 4);
    const double* const t = &time[first[i]];
    for (std::size_t a = 0; a < 4; ++a) {
      basis[i][a] = 1;
      for (std::size_t b = 0; b < 4; ++b) {
        if (b != a) basis[i][a] *= (wanted - t[b]) / (t[a] - t[b]);
      }
    }
  }
  for (std::vector<double>* readings : series) {
    const std::vector<double> logged = *readings;
    for (std::size_t i = 0; i < size; ++i) {
      (*readings)[i] = std::inner_product(basis[i].begin(), basis[i].end(), &logged[first[i]], 0.0);
    }
  }
}

/// The log's heading is `angle` to the right of the airframe's.
void misalign(FlightPrediction& p, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (std::size_t i = 0; i < p.airspeed.size(); ++i) {
    const double ahead = p.airspeed[i];
    const double aside = p.aside[i];
    const DragForces own = law_drag(p, i, ahead * c - aside * s, ahead * s + aside * c);
    const auto acceleration = [&](double thrust, double drag) {
      return p.lift[i] * thrust - drag / p.record.mass;
    };
    // Along the drone's own axes. What effects did to the drag stays as it was.
    const double forward =
        acceleration(p.thrust.tan_tilt[i], p.drag[i] + own.forward - p.law_drag[i]);
    const double sideward =
        acceleration(p.thrust.sideward[i], p.side_drag[i] + own.right - p.law_side_drag[i]);
    p.acceleration[i] += forward * c + sideward * s - acceleration(p.thrust.tan_tilt[i], p.drag[i]);
    p.side_acceleration[i] +=
        sideward * c - forward * s - acceleration(p.thrust.sideward[i], p.side_drag[i]);
  }
}

/// A first-order lag of a course that is straight between samples.
std::vector<double> lagging(const std::vector<double>& time, double constant,
                            std::vector<double> reading) {
  double lagging = reading.empty() ? 0 : reading.front();
  double before = lagging;
  for (std::size_t i = 1; i < reading.size(); ++i) {
    const double step = time[i] - time[i - 1];
    const double slope = (reading[i] - before) / step;
    const double behind = before - slope * constant;  // where a ramp through both would be followed
    before = reading[i];
    lagging = reading[i] - slope * constant + (lagging - behind) * std::exp(-step / constant);
    reading[i] = lagging;
  }
  return reading;
}

/// The acceleration as a velocity over ground shows it that lags by `constant`, whichever way the
/// drone points.
void lag_acceleration(FlightPrediction& p, double constant) {
  const FlightRecord& record = p.record;
  std::vector<double> along(record.size());
  std::vector<double> right(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    const OverGround true_one = over_ground(record, i, {p.acceleration[i], p.side_acceleration[i]});
    along[i] = true_one.along;
    right[i] = true_one.right;
  }
  along = lagging(record.time, constant, std::move(along));
  right = lagging(record.time, constant, std::move(right));
  for (std::size_t i = 0; i < record.size(); ++i) {
    const AtDrone logged = at_drone(record, i, {along[i], right[i]});
    p.acceleration[i] = logged.forward;
    p.side_acceleration[i] = logged.right;
  }
}

/// The logged velocity over ground follows the true one with a lag of first order.
void lag(FlightPrediction& p, double constant) {
  const std::vector<double> acceleration = p.acceleration;
  const std::vector<double> side_acceleration = p.side_acceleration;
  lag_acceleration(p, constant);
  // The true speed is ahead by what the logged one gains in a time constant.
  const double sideways = p.record.both_axes ? constant : 0;
  for (std::size_t i = 0; i < p.acceleration.size(); ++i) {
    const DragForces truly = law_drag(p, i, p.airspeed[i] + constant * p.acceleration[i],
                                      p.aside[i] + sideways * p.side_acceleration[i]);
    p.acceleration[i] = acceleration[i] - (truly.forward - p.law_drag[i]) / p.record.mass;
    p.side_acceleration[i] =
        side_acceleration[i] - (truly.right - p.law_side_drag[i]) / p.record.mass;
  }
  lag_acceleration(p, constant);
}

/// Along the mean heading, and to its right as the imaginary part.
using InPlane = std::complex<double>;

/// A load on a rope below a drone that gives way to it: m ahead of the drone, and how fast.
struct Swing {
  InPlane ahead;
  InPlane speed;
};

/// ẍ = −stiffness·x − 2·fading·ẋ − the acceleration that drives it.
struct Pendulum {
  double stiffness = 0;  ///< 1/s²
  double fading = 0;     ///< 1/s

  [[nodiscard]] Swing hanging(InPlane driving) const { return {-driving / stiffness, 0}; }
  /// `step` s later, of the same drive all the while.
  [[nodiscard]] Swing moved(const Swing& from, InPlane driving, double step) const {
    const double turning = std::sqrt(stiffness - fading * fading);
    const double left = std::exp(-fading * step);
    const double cosine = left * std::cos(turning * step);
    const double sine = left * std::sin(turning * step);
    const InPlane still = hanging(driving).ahead;
    const InPlane off = from.ahead - still;
    return {still + off * cosine + (from.speed + fading * off) / turning * sine,
            from.speed * cosine - (fading * from.speed + stiffness * off) / turning * sine};
  }
};

/// A load of `load` times the drone's mass swings below it on a rope of `rope` m. The drone gives
/// way to it, so that both swing faster than the rope alone would. What drives it is the
/// acceleration predicted without it: gusts that only the measured one has are missing, but noise
/// of what is to be explained cannot explain itself.
void swing(FlightPrediction& p, double load, double rope, double damping) {
  constexpr double longest_step = 2;  // s; after more it is taken to hang still
  const FlightRecord& record = p.record;
  const double own = record.gravity / rope;  // 1/s², of the rope below a drone held still
  const Pendulum pendulum{.stiffness = (1 + load) * own, .fading = damping * std::sqrt(own)};
  Swing swing;
  InPlane before;
  for (std::size_t i = 0; i < record.size(); ++i) {
    // The thrust carries the load as well.
    const double more_lift = load * p.lift[i];
    const double forward = p.acceleration[i] + more_lift * p.thrust.tan_tilt[i];
    const double sideward = p.side_acceleration[i] + more_lift * p.thrust.sideward[i];
    const auto [along, right] = over_ground(record, i, {forward, record.both_axes ? sideward : 0});
    const InPlane driving(along, right);
    const double step = i > 0 ? record.time[i] - record.time[i - 1] : infinity;
    swing = step > longest_step ? pendulum.hanging(driving)
                                : pendulum.moved(swing, (before + driving) / 2.0, step);
    before = driving;
    const AtDrone ahead = at_drone(record, i, {swing.ahead.real(), swing.ahead.imag()});
    p.acceleration[i] = forward + load * own * ahead.forward;
    p.side_acceleration[i] = sideward + load * own * ahead.right;
  }
}

/// A control loop that is close to ringing looks a little like a swing: in a simulated flight
/// without a load it gained 2.9 %.
constexpr double rings_like_a_loop = 2;

/// Of a wind that is never quite steady some happens to change as the height does: in a simulated
/// flight without a shear it gained 2.3 %.
constexpr double happens_to_follow_height = 2;

/// Below it swings faster than a drone leans.
constexpr double shortest_rope = 0.5;  // m

/// A controller leans against errors of the very velocity that is logged, which looks a little as
/// if the attitude were early: simulated loops that do so made gains of 2.0 to 2.6 %.
constexpr double followed_by_the_controller = 1.5;

/// Knots, miles an hour and feet a second read as metres a second are too large; an optical flow
/// that takes its height for a third too low is too small by as much. Gusts that the controller
/// leans against make simulated drones follow half of their thrust, as if it were less still.
constexpr double least_velocity_scale = 0.7;

/// A size of a wind.
EffectParameter wind_part(std::string name, Shown shown = Shown::always) {
  return {.name = std::move(name),
          .unit = "m/s",
          .lower = -40,
          .upper = 40,
          .scale = 0.5,
          .shown = shown};
}

std::vector<Effect> flight_effects() {
  return {
      {.id = "attitude_delay",
       .title = "Attitude logged late, or early",
       .mechanism = "The logged attitude lags behind the logged velocity, or leads it (estimator "
                    "filter, clock offset between channels), so thrust seems to act before the "
                    "drone tilts, or after.",
       .parameters =
           {{.name = "attitude_delay_s", .unit = "s", .lower = -0.5, .upper = 0.5, .scale = 0.05}},
       .to_separate = "fly quick reversals of pitch at low speed, where drag is small and only the "
                      "timing of the thrust matters",
       .change = "θ(t) → θ(t + τ)",
       .channel = "tilt_rate",
       .least_gain_factor = followed_by_the_controller,
       .flight_phase = FlightPhase::attitude,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             if (x[0] == 0) return;
             shift(p.record.time, x[0], {&p.thrust.tilt, &p.thrust.sideward});
           },
       .is_delay = true},

      {.id = "pitch_trim",
       .title = "Pitch offset of the attitude estimate",
       .mechanism = "The estimator reads this pitch when the thrust points straight up, so a "
                    "constant sideways part of the thrust is missed or invented.",
       .parameters = {{.name = "pitch_trim_deg",
                       .unit = "deg",
                       .unit_SI = unit::degree,
                       .lower = -20,
                       .upper = 20,
                       .scale = 0.5}},
       .to_separate = "hover through all headings in still air: the mean pitch is the offset, a "
                      "wind averages out",
       .change = "θ → θ + trim (pitch positive nose-up, θ positive leaning forward)",
       .channel = "tilt",
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::attitude,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (double& tilt : p.thrust.tilt) tilt += x[0];
           }},

      {.id = "linear_drag",
       .title = "Drag in proportion to speed",
       .mechanism = "Propellers in a cross-flow lose momentum in proportion to the airspeed "
                    "(induced drag), beside the quadratic drag of the body.",
       .parameters = {{.name = "linear_m_s",
                       .unit = "m/s",
                       .lower = 0,
                       .upper = 1000,
                       .scale = 5,
                       .spec_field = "drone.drag.linear_m_s",
                       .product_with = "front_area_m2"}},
       .to_separate =
           "fly at speeds from a walk to the fastest, so that linear and quadratic drag part",
       .change = "F_D: u|u| → u|u| + j·u",
       .channel = "forward_speed",
       .in_first_look = true,
       .flight_phase = FlightPhase::air,
       .on_flight = [](FlightPrediction& p, Values x) { p.law.linear_speed += x[0]; }},

      {.id = "wind",
       .title = "Steady wind along the flight axis",
       .mechanism = "The air moves along the forward axis, so airspeed differs from the logged "
                    "speed over ground.",
       .parameters = {wind_part("wind_m_s"), wind_part("crosswind_m_s", Shown::to_the_side)},
       .sizes = 2,
       .to_separate = "fly the same passes at the opposite heading: a wind changes its sign, what "
                      "belongs to the drone does not",
       .change = "u = v − w",
       .channel = "forward_speed",
       .own_in_each_flight = true,
       .in_first_look = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.headwind.size(); ++i) blow_at_drone(p, i, x[0], x[1]);
           }},

      {.id = "turning_wind",
       .title = "Wind fixed in the world while the drone turns",
       .mechanism = "The wind keeps its direction over ground, so its part along the forward axis "
                    "changes whenever the yaw does.",
       .parameters = {wind_part("wind_north_m_s"), wind_part("wind_east_m_s")},
       .sizes = 2,
       .to_separate = "fly passes at four headings, a quarter turn apart",
       .change = "u = v − (w_N cos ψ + w_E sin ψ), ψ the yaw",
       .channel = "yaw",
       .aliased_because =
           "the yaw hardly turns in this flight, where a wind over ground is a steady headwind",
       .replaces = "wind",
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             if (x[0] == 0 && x[1] == 0) return;
             const double c = std::cos(p.record.mean_heading);
             const double s = std::sin(p.record.mean_heading);
             for (std::size_t i = 0; i < p.headwind.size(); ++i) {
               blow(p, i, x[0] * c + x[1] * s, x[1] * c - x[0] * s);
             }
           }},

      {.id = "wind_drift",
       .title = "Wind that changes steadily during the flight",
       .mechanism = "The wind over ground rises or falls from the beginning of the flight to its "
                    "end.",
       .parameters = {wind_part("wind_drift_m_s"),
                      wind_part("wind_drift_right_m_s", Shown::turning_or_to_the_side)},
       .sizes = 2,
       .to_separate = "repeat the first passes at the end of the flight",
       .change = "w → w + (d_a cos(ψ − ψ̄) + d_r sin(ψ − ψ̄))·(t − t_middle)/duration: d is the "
                 "change over the whole flight, ψ̄ the mean heading",
       .channel = "time",
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             if (!(p.record.duration > 0)) return;
             for (std::size_t i = 0; i < p.headwind.size(); ++i) {
               const double part = (p.record.time[i] - p.record.middle_time) / p.record.duration;
               blow(p, i, x[0] * part, x[1] * part);
             }
           }},

      {.id = "wind_shear",
       .title = "Wind that changes with height",
       .mechanism = "The wind grows or turns with the height over ground.",
       .parameters = {{.name = "wind_shear_m_s_m",
                       .unit = "m/s per m",
                       .lower = -2,
                       .upper = 2,
                       .scale = 0.02},
                      {.name = "wind_shear_right_m_s_m",
                       .unit = "m/s per m",
                       .lower = -2,
                       .upper = 2,
                       .scale = 0.02,
                       .shown = Shown::turning_or_to_the_side}},
       .sizes = 2,
       .needs = {"vd_m_s"},
       .to_separate = "repeat the first passes, then fly them at another height",
       .change = "w → w + (s_a cos(ψ − ψ̄) + s_r sin(ψ − ψ̄))·(h − h̄), h̄ the mean height",
       .channel = "height",
       .least_gain_factor = happens_to_follow_height,
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.headwind.size(); ++i) {
               const double above = p.record.height[i] - p.record.mean_height;
               blow(p, i, x[0] * above, x[1] * above);
             }
           }},

      {.id = "fore_aft_asymmetry",
       .title = "Different drag forward and backward",
       .mechanism = "The airframe is not symmetric: at the same airspeed, drag flying forward is "
                    "(1 + a)/(1 − a) times that flying backward.",
       .parameters = {{.name = "fore_aft_asymmetry",
                       .unit = "1",
                       .lower = -0.95,
                       .upper = 0.95,
                       .scale = 0.05,
                       .spec_field = "drone.drag.fore_aft_asymmetry",
                       .product_with = "front_area_m2"}},
       .to_separate =
           "fly the same passes at the opposite heading, and slow ones as well as fast ones: a "
           "wind changes its sign, an offset of the pitch does not grow with speed",
       .change = "F_D → F_D·(1 + a·sign u)",
       .channel = "forward_speed",
       .flight_phase = FlightPhase::air,
       .on_flight = [](FlightPrediction& p, Values x) { p.law.fore_aft_asymmetry += x[0]; }},

      {.id = "propwash",
       .title = "Propwash while braking",
       .mechanism = "Leaning against the motion, the drone flies into the turbulent air of its own "
                    "propellers, which changes the drag with speed and tilt.",
       .parameters =
           {{.name = "propwash", .unit = "N·s/(m·rad)", .lower = -5, .upper = 5, .scale = 0.1}},
       .to_separate = "brake at the same speed with different tilts",
       .change = "F_D → F_D − k·u·|θ| while u·θ < 0",
       .channel = "braking",
       .flight_phase = FlightPhase::force,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.drag.size(); ++i) {
               const double against = -p.airspeed[i] * p.thrust.tilt[i];
               if (against > 0) p.drag[i] -= x[0] * p.airspeed[i] * std::abs(p.thrust.tilt[i]);
               const double sideward = p.thrust.sideward[i];
               if (p.aside[i] * sideward < 0) {
                 p.side_drag[i] -= x[0] * p.aside[i] * std::abs(std::atan(sideward));
               }
             }
           }},

      {.id = "vertical_coupling",
       .title = "Drag that depends on climbing and sinking",
       .mechanism = "Flow through the propellers from below or above changes the "
                    "force they feel from the side.",
       .parameters = {{.name = "vertical_coupling",
                       .unit = "N·s²/m²",
                       .lower = -2,
                       .upper = 2,
                       .scale = 0.05}},
       .needs = {"vd_m_s"},
       .to_separate = "climb and sink at constant forward speed",
       .change = "F_D → F_D + c·u·v_D",
       .channel = "sinking",
       .flight_phase = FlightPhase::force,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.drag.size(); ++i) {
               p.drag[i] += x[0] * p.airspeed[i] * p.record.down_speed[i];
               p.side_drag[i] += x[0] * p.aside[i] * p.record.down_speed[i];
             }
           }},

      {.id = "tether_pull",
       .title = "A steady pull to one side",
       .mechanism = "The tether, or whatever else holds the drone, pulls it to one side over "
                    "ground with the same force all the time.",
       .parameters =
           {{.name = "pull_ahead_N", .unit = "N", .lower = -200, .upper = 200, .scale = 0.1},
            {.name = "pull_right_N",
             .unit = "N",
             .lower = -200,
             .upper = 200,
             .scale = 0.1,
             .shown = Shown::turning_or_to_the_side}},
       .sizes = 2,
       .to_separate = "lean more and less at the same speed, and fly the passes at the opposite "
                      "heading: the pull keeps its size and its side, what belongs to the drone "
                      "turns with it",
       .change = "F_D → F_D − (F_a cos(ψ − ψ̄) + F_r sin(ψ − ψ̄)), ψ̄ the mean heading",
       .channel = "yaw",
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::force,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.drag.size(); ++i) pull(p, i, x[0], x[1]);
           }},

      {.id = "growing_pull",
       .title = "A pull back that grows with the distance",
       .mechanism = "The tether pulls the drone back to its station, the more the further it is "
                    "away: a longer cable hangs flatter and carries more of its weight sideways.",
       .parameters = {{.name = "pull_N_m", .unit = "N/m", .lower = 0, .upper = 50, .scale = 0.01}},
       .to_separate = "fly the same passes near the station and far from it: what belongs to the "
                      "drone or to the air does not know where the station stands",
       .change = "F_D → F_D + k·(x cos(ψ − ψ̄) + y sin(ψ − ψ̄)), (x, y) the place from the mean one, "
                 "along the mean heading ψ̄ and to its right",
       .channel = "place",
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::force,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.drag.size(); ++i) {
               pull(p, i, -x[0] * p.record.place_along[i], -x[0] * p.record.place_right[i]);
             }
           }},

      {.id = "wind_step",
       .title = "Wind that changes at once",
       .mechanism =
           "From one moment on another wind blows: a front passes, or the drone leaves the "
           "lee of something.",
       .parameters = {wind_part("wind_step_ahead_m_s"),
                      wind_part("wind_step_right_m_s", Shown::turning_or_to_the_side),
                      {.name = "wind_step_time_s",
                       .unit = "s",
                       .look_through = LookThrough::moments}},
       .sizes = 2,
       .to_separate = "fly the same passes fast and slow before and after: a wind acts in "
                      "proportion to the speed, a force does not",
       .change = "w → w + Δw_a cos(ψ − ψ̄) + Δw_r sin(ψ − ψ̄) from the time on, ψ̄ the mean heading",
       .channel = "time",
       .least_gain_factor = 5,
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.headwind.size(); ++i) {
               if (p.record.time[i] >= x[2]) blow(p, i, x[0], x[1]);
             }
           }},

      {.id = "wind_wave",
       .title = "Wind that comes and goes",
       .mechanism = "The wind rises and falls slowly, many seconds up and many down, as below "
                    "thermals or behind hills.",
       .parameters = {wind_part("wind_wave_cos_m_s"),
                      wind_part("wind_wave_sin_m_s"),
                      wind_part("wind_wave_right_cos_m_s", Shown::turning_or_to_the_side),
                      wind_part("wind_wave_right_sin_m_s", Shown::turning_or_to_the_side),
                      {.name = "wind_wave_period_s",
                       .unit = "s",
                       .neutral = 40,
                       .lower = 40,
                       .upper = 1e6,
                       .look_through = LookThrough::periods}},
       .sizes = 4,
       .to_separate = "fly the same passes for several of its periods, and measure the wind",
       .change = "w → w + a cos(2πt/T) + b sin(2πt/T), t from the middle of the flight",
       .channel = "time",
       .least_gain_factor = 5,
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::air,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.headwind.size(); ++i) {
               const double phase =
                   2 * std::numbers::pi * (p.record.time[i] - p.record.middle_time) / x[4];
               const double cosine = std::cos(phase);
               const double sine = std::sin(phase);
               blow(p, i, x[0] * cosine + x[1] * sine, x[2] * cosine + x[3] * sine);
             }
           }},

      {.id = "mass_drop",
       .title = "The drone becomes lighter at once",
       .mechanism = "From one moment on the drone is lighter by a part of its mass (a payload "
                    "dropped), so that the same drag slows it more. A drag that grows in "
                    "proportion (gear let down) looks the same.",
       .parameters = {{.name = "mass_drop_percent",
                       .unit = "%",
                       .unit_SI = 0.01,
                       .lower = 0,
                       .upper = 90,
                       .scale = 5},
                      {.name = "mass_drop_time_s",
                       .unit = "s",
                       .look_through = LookThrough::moments}},
       .to_separate = "compare the thrust in hover before and after, in a log of the power",
       .change = "m → m·(1 − x) from the time on",
       .channel = "time",
       .least_gain_factor = 5,
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::force,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             for (std::size_t i = 0; i < p.drag.size(); ++i) {
               if (p.record.time[i] < x[1]) continue;
               p.drag[i] /= 1 - x[0];
               p.side_drag[i] /= 1 - x[0];
             }
           }},

      {.id = "slung_load",
       .title = "A load that swings on a rope",
       .mechanism = "A load hangs from the drone on a rope. It lags behind as the drone speeds up, "
                    "then swings, and pulls the drone to and fro.",
       .parameters =
           {{.name = "slung_load_percent",
             .unit = "%",
             .unit_SI = 0.01,
             .lower = 0,
             .upper = 300,
             .scale = 5},
            {.name = "rope_length_m",
             .unit = "m",
             .neutral = shortest_rope,
             .lower = shortest_rope,
             .upper = 25,
             .scale = 0.1,
             .look_through = LookThrough::ratios},
            {.name = "swing_damping", .unit = "1", .upper = 0.5, .scale = 0.02, .start = 0.05}},
       .to_separate = "fly the same passes without the load",
       .change = "v̇ → (1 + μ)·g tan θ − F_D/m + μ·g·x/l: the load, μ of the drone's mass m, is x "
                 "ahead of it, ẍ = −g·x/l − 2ζ√(g/l)·ẋ − v̇",
       .channel = "tilt_rate",
       .least_gain_factor = rings_like_a_loop,
       .own_in_each_flight = true,
       .flight_phase = FlightPhase::reading,
       .on_flight = [](FlightPrediction& p, Values x) { swing(p, x[0], x[1], x[2]); }},

      {.id = "yaw_misalign",
       .title = "Heading off from the airframe",
       .mechanism = "The compass is turned against the airframe, so that speed and acceleration "
                    "are split into forward and sideward along the wrong axes.",
       .parameters = {{.name = "yaw_misalign_deg",
                       .unit = "deg",
                       .unit_SI = unit::degree,
                       .lower = -60,
                       .upper = 60,
                       .scale = 2}},
       .to_separate = "fly straight ahead, then straight to the side: a heading that is off shows "
                      "each of them in the other axis",
       .change = "forward and right axes turned by δ against the log's",
       .channel = "yaw",
       .flight_phase = FlightPhase::reading,
       .on_flight = [](FlightPrediction& p, Values x) { misalign(p, x[0]); },
       // Either way it slows the drone down, so that the error is no slope but a saddle at 0.
       .starts_at = heading_from_leaning},

      {.id = "velocity_lag",
       .title = "Velocity logged late",
       .mechanism =
           "The estimator smooths the velocity, so that the logged acceleration lags behind "
           "the thrust.",
       .parameters =
           {{.name = "velocity_lag_s", .unit = "s", .lower = 0, .upper = 2, .scale = 0.05}},
       .to_separate = "fly quick reversals of pitch at low speed; a smoothed velocity rounds them, "
                      "an attitude that is early only shifts them",
       .change = "v̇ follows with a lag of first order, τ",
       .channel = "tilt_rate",
       .least_gain_factor = followed_by_the_controller,
       .flight_phase = FlightPhase::reading,
       .on_flight =
           [](FlightPrediction& p, Values x) {
             if (x[0] > 0) lag(p, x[0]);
           },
       .is_delay = true},

      {.id = "velocity_scale",
       .title = "Velocity logged too large or too small",
       .mechanism = "Every logged velocity is the true one times a factor, so that accelerations "
                    "and drag do not fit the thrust together. Angles that are logged too small "
                    "by that factor show the same.",
       .parameters = {{.name = "velocity_scale",
                       .unit = "1",
                       .neutral = 1,
                       .lower = least_velocity_scale,
                       .upper = 5,
                       .scale = 0.02}},
       .needs = {"vd_m_s"},
       .to_separate = "compare a measured distance with the log's",
       .change = "u → u/s, a → s·a",
       .channel = "forward_speed",
       .least_gain_factor = 5,
       .flight_phase = FlightPhase::reading,
       .on_flight = [](FlightPrediction& p, Values x) {
         for (std::size_t i = 0; i < p.acceleration.size(); ++i) {
           const DragForces own = law_drag(p, i, p.airspeed[i] / x[0], p.aside[i] / x[0]);
           p.acceleration[i] =
               x[0] * (p.acceleration[i] + (p.law_drag[i] - own.forward) / p.record.mass);
           p.side_acceleration[i] =
               x[0] * (p.side_acceleration[i] + (p.law_side_drag[i] - own.right) / p.record.mass);
         }
       }}};
}

std::vector<Effect> all_effects() {
  std::vector<Effect> effects = flight_effects();
  for (Effect& effect : power_effects()) effects.push_back(std::move(effect));
  return effects;
}

}  // namespace

std::span<const Effect> effect_catalogue() {
  static const std::vector<Effect> effects = all_effects();
  return effects;
}

std::span<const Effect> effect_catalogue(LogKind kind) {
  static const std::size_t flights = flight_effects().size();
  const std::span<const Effect> all = effect_catalogue();
  return kind == LogKind::flight ? all.first(flights) : all.subspan(flights);
}

const Effect* find_effect(std::string_view id) {
  const auto effects = effect_catalogue();
  const auto found = std::find_if(effects.begin(), effects.end(),
                                  [id](const Effect& effect) { return effect.id == id; });
  return found == effects.end() ? nullptr : &*found;
}

std::string in_words(std::string id) {
  std::ranges::replace(id, '_', ' ');
  return id;
}

std::string_view to_string(Stage stage) {
  constexpr std::array<std::string_view, 5> names{"supply", "tether", "converter", "motors",
                                                  "airframe"};  // in the order of the stages
  return names[static_cast<std::size_t>(stage)];
}

std::string_view to_string(LogKind kind) { return kind == LogKind::flight ? "flight" : "power"; }

}  // namespace tethercalc
