// A simulated drag flight: its own physics, integrated in small steps, as a log at 10 Hz.
//
// Nothing of the library's model is used, so that the library can be judged by it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc::test {

/// The drone, the air and the pilot. The defaults resemble a 1.5 kg quadrotor in light wind.
struct SimulatedFlight {
  double mass = 1.6;              // kg
  double air_density = 1.225;     // kg/m³
  double front_area = 0.0150;     // m², with drag coefficient
  double top_area = 0.0140;       // m², with drag coefficient
  double linear_speed = 19;       // m/s
  double wind = -1.2;             // m/s along the forward axis
  double disturbance = 0.28;      // m/s², standard deviation of gusts and thrust errors
  double disturbance_time = 0.3;  // s, their correlation time: 10 Hz residuals with lag-1 near 0.86
  double pitch_offset = 0;        // rad, added to the recorded pitch
  double heading = 1.0;           // rad
  double attitude_lag = 0.15;     // s, how fast the drone follows the commanded tilt
  double slew_rate_deg_s = 90;    // how fast the command itself changes
  double min_tilt_deg = 6;
  double max_tilt_deg = 30;
  double duration = 300;  // s of passes
  double idle = 0;        // s on the ground before take-off and after landing
  double start_time = 5;  // s on the log's clock
  std::uint64_t seed = 1;
};

/// Random numbers that are the same on every machine, unlike those of std::normal_distribution.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) / 9007199254740992.0; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {
    return std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

/// Noise with a correlation time: an Ornstein–Uhlenbeck process, stepped exactly.
class ColouredNoise {
 public:
  ColouredNoise(double deviation, double correlation_time, double step)
      : keep_(std::exp(-step / correlation_time)),
        kick_(deviation * std::sqrt(1 - keep_ * keep_)),
        deviation_(deviation) {}
  double start(Dice& dice) { return value_ = deviation_ * dice.normal(); }
  double next(Dice& dice) { return value_ = keep_ * value_ + kick_ * dice.normal(); }

 private:
  double keep_, kick_, deviation_;
  double value_ = 0;
};

/// Flies passes forward and backward as a pilot does in an angle mode: hold a tilt until the drone
/// is fast or has flown long enough, then lean the other way; a little steeper or shallower each
/// time. Where there is ground to land on, the last seconds are spent on coming to rest.
inline FlightLog simulate(const SimulatedFlight& f) {
  constexpr double gravity = 9.80665;
  constexpr double degree = 0.017453292519943295;
  constexpr double step = 0.01;  // s, of the integration
  constexpr int steps_a_sample = 10;

  Dice dice(f.seed);
  ColouredNoise push(f.disturbance, f.disturbance_time, step);
  ColouredNoise heave(0.25, 0.8, step);  // m/s², vertical
  ColouredNoise sway(0.4, 1.5, step);    // m/s², sideways
  ColouredNoise roll(1.2 * degree, 0.7, step);
  ColouredNoise shake(0.25 * degree, 0.3, step);
  ColouredNoise turn(1.5 * degree, 4.0, step);
  ColouredNoise estimator(0.004, 0.3, step);  // m/s, of the velocity estimate
  push.start(dice);

  double tilt = 0, stick = 0, command = 0, stick_until = 0;
  double forward = 0, right = 0, down = 0;
  double forward_before = 0, right_before = 0, down_before = 0;  // m/s², one step ago
  int direction = 1;
  FlightLog log;
  const auto record = [&](double t, double lean, double bank, double yaw, double vf, double vr,
                          double vd) {
    log.time.push_back(f.start_time + t);
    log.pitch.push_back(-lean + f.pitch_offset);
    log.roll.push_back(bank);
    log.yaw.push_back(yaw);
    log.north_velocity.push_back(std::cos(yaw) * vf - std::sin(yaw) * vr);
    log.east_velocity.push_back(std::sin(yaw) * vf + std::cos(yaw) * vr);
    log.down_velocity.push_back(vd);
  };
  const auto wait_on_ground = [&](double from, double until) {
    // Standing on uneven ground: the attitude says nothing about thrust.
    for (double t = from; t < until; t += step * steps_a_sample) {
      // One after the other: compilers differ in the order of arguments.
      const double downwards = 0.01 * dice.normal();
      const double to_the_right = 0.01 * dice.normal();
      const double ahead = 0.01 * dice.normal();
      const double lean = 0.06 + 1e-4 * dice.normal();
      record(t, lean, -0.02, f.heading, ahead, to_the_right, downwards);
    }
  };

  wait_on_ground(0, f.idle);
  const auto samples = static_cast<int>(f.duration / (step * steps_a_sample));
  for (int i = 0; i < samples * steps_a_sample; ++i) {
    const double t = i * step;
    if (t >= stick_until) {
      direction = -direction;
      stick = direction * degree * dice.between(f.min_tilt_deg, f.max_tilt_deg);
      stick_until = t + dice.between(4, 9);
    }
    if (f.idle > 0 && t > f.duration - 12) {
      stick = std::clamp(-0.05 * forward, -15 * degree, 15 * degree);
    }
    const double slew = f.slew_rate_deg_s * degree * step;
    command += std::clamp(stick - command, -slew, slew);
    tilt += (command - tilt) * step / f.attitude_lag;
    const double lean = tilt + shake.next(dice);
    const double bank = roll.next(dice);
    const double yaw = f.heading + turn.next(dice);

    // Thrust carries the drone, up to an imperfect altitude hold; leaned, it also drives it. The
    // speeds at t follow from the accelerations before and at t (Heun's method), so that attitude
    // and velocity belong to the same instant.
    const double sag = heave.next(dice);
    const double sideways = sway.next(dice);
    const double gust = push.next(dice);
    const auto down_rate = [&](double vd) { return sag - 0.8 * vd; };
    const auto right_rate = [&](double vr) { return sideways - 0.7 * vr; };
    const auto forward_rate = [&](double vf) {
      const double thrust = (gravity - down_rate(down)) / (std::cos(lean) * std::cos(bank));
      const double airspeed = vf - f.wind;
      const double area = f.front_area * std::cos(lean) + f.top_area * std::abs(std::sin(lean));
      const double drag = 0.5 * f.air_density * area *
                          (airspeed * std::abs(airspeed) + f.linear_speed * airspeed) / f.mass;
      return thrust * std::sin(lean) * std::cos(bank) - drag + gust;
    };
    down += 0.5 * step * (down_before + down_rate(down + step * down_before));
    right += 0.5 * step * (right_before + right_rate(right + step * right_before));
    forward += 0.5 * step * (forward_before + forward_rate(forward + step * forward_before));
    down_before = down_rate(down);
    right_before = right_rate(right);
    forward_before = forward_rate(forward);
    const double error = estimator.next(dice);
    if (i % steps_a_sample == 0) record(f.idle + t, lean, bank, yaw, forward + error, right, down);
  }
  if (f.idle > 0) wait_on_ground(f.idle + f.duration, 2 * f.idle + f.duration);
  return log;
}

}  // namespace tethercalc::test
