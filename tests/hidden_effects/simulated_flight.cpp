#include "hidden_effects/simulated_flight.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <utility>

namespace tethercalc::truth {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double gravity = 9.80665;
constexpr double step = 0.01;           // s, integration
constexpr double pitch_rate = 0.6;      // rad/s, as fast as the pilot tilts the drone
constexpr double response_time = 0.12;  // s, attitude controller
constexpr double climb_period = 120;    // s

using Random = std::mt19937_64;

double normal(Random& random) { return std::normal_distribution<double>()(random); }
double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// First-order Gauss–Markov process sampled at the integration step.
class Wander {
 public:
  Wander(double std, double time) : std_(std), keep_(std::exp(-step / time)) {}
  double next(Random& random) {
    value_ = keep_ * value_ + std_ * std::sqrt(1 - keep_ * keep_) * normal(random);
    return value_;
  }

 private:
  double std_;
  double keep_;
  double value_ = 0;
};

/// What follows with a lag of first order. Between two steps what is followed changes evenly: taken
/// at their ends alone it would be followed half a step sooner or later than the lag says.
class Lagging {
 public:
  explicit Lagging(double lag) : keep_(lag > 0 ? std::exp(-step / lag) : 0), is_late_(lag > 0) {}
  double next(double followed) {
    const double halfway = is_late_ ? (before_ + followed) / 2 : followed;
    before_ = followed;
    value_ = keep_ * value_ + (1 - keep_) * halfway;
    return value_;
  }

 private:
  double keep_;
  bool is_late_;
  double before_ = 0;
  double value_ = 0;
};

/// Forward and backward passes: tilt into the motion, hold, tilt against it, with pauses.
class Pilot {
 public:
  Pilot(Pattern pattern, double steepest, double duration)
      : pattern_(pattern), steepest_(steepest * degree), duration_(duration) {}
  double tilt(double time, Random& random) {
    if (time >= until_) {
      direction_ = -direction_;
      const bool pause =
          uniform(random, 0, 1) < 0.1 || (pattern_ == Pattern::hover_first && time < duration_ / 3);
      wanted_ = pause ? 0 : direction_ * uniform(random, 0.2, 1) * steepest_;
      until_ = time + uniform(random, 2.5, 8);
      if (pattern_ == Pattern::long_forward && direction_ > 0) {
        until_ += uniform(random, 10, 30);
        wanted_ *= 0.6;
      }
    }
    commanded_ += std::clamp(wanted_ - commanded_, -pitch_rate * step, pitch_rate * step);
    actual_ += (commanded_ - actual_) * step / response_time;
    return actual_;
  }

 private:
  Pattern pattern_;
  double steepest_;
  double duration_;
  double direction_ = 1;
  double until_ = 0;
  double wanted_ = 0;
  double commanded_ = 0;
  double actual_ = 0;
};

/// Flies legs: the wanted speed follows from time alone, the lean from what the speed and the place
/// are behind, as a cascade of controllers does. Along both axes of the drone alike.
class Autopilot {
 public:
  explicit Autopilot(const HiddenFlight& hidden) : hidden_(hidden) {}

  [[nodiscard]] bool is_done() const { return leg_ >= hidden_.course.size(); }
  [[nodiscard]] double yaw(double now) const { return is_done() ? now : leg().heading; }
  [[nodiscard]] double tilt() const { return ahead_.actual; }
  [[nodiscard]] double roll() const { return aside_.actual; }
  [[nodiscard]] double sinking() const { return sinking_; }

  void advance(double yaw, double speed, double right) {
    if (is_done()) return;
    const bool turned = std::abs(std::remainder(leg().heading - yaw, 2 * std::numbers::pi)) < 0.01;
    const double length = std::hypot(leg().ahead, leg().aside, leg().climb);
    const double a = hidden_.course_acceleration;
    const double top = std::min(leg().speed, std::sqrt(a * length));
    const double ramp = top / a;
    const double flown = length > 0 ? length / top + ramp : 0;
    if (turned || time_ > 0) time_ += step;
    double wanted = 0;
    if (time_ < flown) wanted = top * std::min({1.0, time_ / ramp, (flown - time_) / ramp});
    const double part = length > 0 ? wanted / length : 0;
    sinking_ = -part * leg().climb;
    ahead_.follow(part * leg().ahead, speed);
    aside_.follow(part * leg().aside, right);
    if (time_ < flown + leg().hold) return;
    time_ = 0;
    ++leg_;
  }

 private:
  struct Axis {
    double smooth = 0;  ///< wanted speed, rounded
    double behind = 0;  ///< m
    double actual = 0;  ///< rad
    double sum = 0;     ///< m/s², what wind and drag take
    double commanded = 0;
    void follow(double wanted, double speed) {
      const double before = smooth;
      smooth += (wanted - smooth) * step / 0.3;
      behind += (smooth - speed) * step;
      const double error = smooth - speed + 0.6 * behind;
      sum = std::clamp(sum + 0.5 * error * step, -5.0, 5.0);
      const double lean = std::atan(((smooth - before) / step + 1.5 * error + sum) / gravity);
      commanded += std::clamp(lean - commanded, -2 * step, 2 * step);
      actual += (commanded - actual) * step / response_time;
    }
  };
  [[nodiscard]] const Leg& leg() const { return hidden_.course[leg_]; }

  const HiddenFlight& hidden_;
  std::size_t leg_ = 0;
  double time_ = 0;
  double sinking_ = 0;
  Axis ahead_;
  Axis aside_;
};

/// A load below the drone, where it is of it and how fast, over ground.
struct SlungLoad {
  double stiffness = 0;  // 1/s²
  double fading = 0;     // 1/s
  double north = 0;
  double east = 0;
  double north_speed = 0;
  double east_speed = 0;

  explicit SlungLoad(const HiddenFlight& h)
      : stiffness(gravity / h.rope), fading(2 * h.swing_damping * std::sqrt(stiffness)) {}
  /// Left behind by a drone that speeds up so.
  void follow(double north_acceleration, double east_acceleration) {
    north_speed -= step * (stiffness * north + fading * north_speed + north_acceleration);
    east_speed -= step * (stiffness * east + fading * east_speed + east_acceleration);
    north += step * north_speed;
    east += step * east_speed;
  }
};

/// Forward; `aside` is the airspeed to the right, which makes the force along the airspeed larger.
double drag(const HiddenFlight& h, double u, double aside, double tilt, double down, double roll,
            double height, bool late) {
  const double area = h.front_area * std::cos(tilt) + h.top_area * std::abs(std::sin(tilt));
  double force = 0.5 * h.air_density * area * (std::hypot(u, aside) + h.linear) * u;
  force *= u > 0 ? 1 + h.fore_aft_asymmetry : 1 - h.fore_aft_asymmetry;
  force += 0.5 * h.air_density * h.tether_area * std::hypot(u, aside) * u;
  if (u * tilt < 0) force -= h.propwash * u * std::abs(tilt);
  force += h.vertical_coupling * u * down;
  force *= std::max(0.2, 1 + h.height_drag * height);
  force += h.roll_drag * u * (1 - std::cos(roll));
  return force - (late ? h.step_force : 0);
}

double side_drag(const HiddenFlight& h, double u, double ahead, double roll, double down) {
  const double area = h.side_area * std::cos(roll) + h.top_area * std::abs(std::sin(roll));
  double force = 0.5 * h.air_density * area * (std::hypot(u, ahead) + h.linear) * u;
  force += 0.5 * h.air_density * h.tether_area * std::hypot(u, ahead) * u;
  if (u * roll < 0) force -= h.propwash * u * std::abs(roll);
  return force + h.vertical_coupling * u * down;
}

/// An angle that is logged late. Each tilt acts from one step to the next: at a step it is between
/// the two. The front two that are kept lie on either side of the delay.
class LoggedLate {
 public:
  explicit LoggedLate(double delay) : steps_(std::max(0.0, delay / step)) {}
  double next(double angle) {
    on_its_way_.push_back((angle + last_) / 2);
    last_ = angle;
    if (static_cast<double>(on_its_way_.size()) > steps_ + 2) on_its_way_.pop_front();
    const double part = steps_ - std::floor(steps_);
    return on_its_way_.size() < 2 ? on_its_way_.front()
                                  : part * on_its_way_[0] + (1 - part) * on_its_way_[1];
  }

 private:
  double steps_;
  double last_ = 0;
  std::deque<double> on_its_way_;
};

/// What the recorder makes of a log: its stamps jitter, and rows are missing. Draws of its own, so
/// that the flight is the same.
void record(const HiddenFlight& h, FlightLog& log) {
  Random random(~h.seed);
  const double begin = log.time.front();
  const double gap_begin = begin + 0.3 * (log.time.back() - begin);
  FlightLog kept;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const bool in_gap = log.time[i] > gap_begin && log.time[i] < gap_begin + h.gap;
    if (in_gap || uniform(random, 0, 1) < h.lost_rows) continue;
    double stamp = log.time[i] + h.clock_jitter * uniform(random, -1, 1);
    // A clock that is read later never shows less.
    if (!kept.time.empty()) stamp = std::max(stamp, kept.time.back() + 1e-4);
    kept.time.push_back(stamp);
    for (auto series : {&FlightLog::roll, &FlightLog::pitch, &FlightLog::yaw,
                        &FlightLog::north_velocity, &FlightLog::east_velocity,
                        &FlightLog::down_velocity, &FlightLog::north_wind, &FlightLog::east_wind}) {
      if (!(log.*series).empty()) (kept.*series).push_back((log.*series)[i]);
    }
  }
  log = std::move(kept);
}

}  // namespace

void draw_drone(HiddenFlight& hidden, std::mt19937_64& random) {
  hidden.mass = uniform(random, 1.5, 2.3);
  hidden.front_area = uniform(random, 0.010, 0.022);
  hidden.top_area = uniform(random, 0.012, 0.022);
  hidden.linear = uniform(random, 12, 20);
  hidden.wind = uniform(random, -1.8, 1.8);
}

FlightLog fly(const HiddenFlight& h, Flown* flown) {
  Random random(h.seed);
  FlightLog log;
  Pilot pilot(h.pattern, h.steepest_pitch, h.duration);
  Pilot pilot_aside(h.pattern, h.steepest_roll, h.duration);
  Wander gust(h.gust_std, h.gust_time);
  Wander gust_aside(h.gust_std, h.gust_time);
  const bool commanded = !h.course.empty();
  const bool both_axes = h.steepest_roll > 0 || commanded;
  Autopilot autopilot(h);
  Wander rolling(h.roll_std * degree, 1.0);
  Wander sideways(h.lateral_std, 4.5);
  Wander sinking(0.4, 1.5);
  LoggedLate logged_tilt(h.attitude_delay);
  LoggedLate logged_roll(h.attitude_delay);

  double speed = 0;
  double down = 0;
  double height = 10;
  double yaw = uniform(random, 0, 2 * std::numbers::pi);
  if (commanded) yaw = h.course.front().heading;
  const double first_heading = yaw;
  double north = 0;  // m from the start
  double east = 0;
  double drifting = 0;  // m/s to the right, where the roll moves the drone
  SlungLoad load(h);
  const double load_share = h.slung_load / 100;
  Lagging lagging_north{h.velocity_lag};
  Lagging lagging_east{h.velocity_lag};
  double airspeed_sum = 0;
  double speeding_up_sum = 0;
  double square_sum = 0;
  double lift_sum = 0;
  double next_turn = 40;
  double wanted_yaw = yaw;
  const auto steps = static_cast<std::size_t>(h.duration / step);
  for (std::size_t k = 0; commanded ? !autopilot.is_done() : k < steps; ++k) {
    const double time = static_cast<double>(k) * step;
    const bool late = time > 0.45 * h.duration;
    if (h.yaw_turns && time >= next_turn) {
      wanted_yaw += uniform(random, 0.8, 2.2);
      next_turn += 40;
    }
    if (h.pattern == Pattern::circles) wanted_yaw += 2 * std::numbers::pi / 60 * step;
    const double turn = std::clamp(wanted_yaw - yaw, -0.5 * step, 0.5 * step);
    yaw += turn;
    if (commanded) {
      wanted_yaw = yaw + std::remainder(autopilot.yaw(yaw) - yaw, 2 * std::numbers::pi);
      autopilot.advance(yaw, speed, drifting);
    }
    const double tilt = commanded ? autopilot.tilt() : pilot.tilt(time, random);
    double roll = rolling.next(random);
    double right = sideways.next(random);
    if (h.yaw_misalign != 0) {
      roll -= 0.04 * drifting;  // the pilot's hand
      drifting += (gravity * std::tan(roll) / std::cos(tilt) -
                   drag(h, drifting, 0, 0, 0, 0, height - 10, false) / h.mass) *
                  step;
      right = drifting;
    }
    if (both_axes) {
      roll = commanded ? autopilot.roll() : pilot_aside.tilt(time, random);
      right = drifting;
    }
    const double old_down = down;
    const double climbing = -h.climb * std::numbers::pi / climb_period *
                            std::sin(2 * std::numbers::pi * time / climb_period);
    const double rising = h.rise_with_lean * (1 / std::cos(tilt) - 1);
    down += (sinking.next(random) + climbing - rising + autopilot.sinking() - down) * step /
            0.6;  // smooth: inertia
    const double down_acceleration = (down - old_down) / step;
    height -= down * step;
    const double ahead = std::cos(yaw - first_heading);
    const double wave =
        std::cos(2 * std::numbers::pi * (time - h.duration / 2) / h.wind_wave_period);
    // What changes of a wind along the first heading.
    const double drift =
        h.wind_drift * (time / h.duration - 0.5) + h.wind_shear * (height - 10 - h.climb / 2);
    const double along =
        h.wind + drift * ahead + h.wind_north * std::cos(yaw) + h.wind_east * std::sin(yaw) +
        (time > 0.6 * h.duration ? h.wind_step : 0) * ahead + h.wind_wave * wave * ahead;
    const double to_the_left = std::sin(yaw - first_heading);
    const double across = h.crosswind + h.wind_east * std::cos(yaw) - h.wind_north * std::sin(yaw) -
                          (time > 0.6 * h.duration ? h.wind_step : 0) * to_the_left -
                          drift * to_the_left - h.wind_wave * wave * to_the_left;
    const double mass = h.mass * (late ? 1 - h.mass_drop / 100 : 1);
    const double pull_north = h.tether_pull * std::cos(first_heading) +
                              h.growing_pull * (h.station * std::cos(first_heading) - north);
    const double pull_east = h.tether_pull * std::sin(first_heading) +
                             h.growing_pull * (h.station * std::sin(first_heading) - east);
    // The thrust carries the load, too, and its rope pulls.
    const double lift = (1 + load_share) * (gravity - down_acceleration);
    const double rope_north = load_share * load.stiffness * load.north;
    const double rope_east = load_share * load.stiffness * load.east;
    // A frame that turns carries the speed to the right into the forward one.
    const double push =
        lift * std::tan(tilt) + rope_north * std::cos(yaw) + rope_east * std::sin(yaw) +
        gust.next(random) * (1 + h.gust_with_speed * std::abs(speed)) + turn / step * right +
        (pull_north * std::cos(yaw) + pull_east * std::sin(yaw)) / mass;
    const auto acceleration = [&](double v) {
      return push - drag(h, v - along, both_axes ? right - across : 0, tilt, down, roll,
                         height - 10, late) /
                        mass;
    };
    const double halfway = speed + acceleration(speed) * step / 2;
    const double forward_acceleration = acceleration(halfway);
    const double ahead_over_ground = forward_acceleration - turn / step * right;
    double aside_over_ground = 0;
    if (both_axes) {
      const double push_aside = lift * std::tan(roll) / std::cos(tilt) + rope_east * std::cos(yaw) -
                                rope_north * std::sin(yaw) + gust_aside.next(random) -
                                turn / step * speed -
                                (pull_east * std::cos(yaw) - pull_north * std::sin(yaw)) / mass;
      const auto acceleration_aside = [&](double v) {
        return push_aside - side_drag(h, v - across, speed - along, roll, down) / mass;
      };
      const double half_aside = drifting + acceleration_aside(drifting) * step / 2;
      const double right_acceleration = acceleration_aside(half_aside);
      aside_over_ground = right_acceleration + turn / step * speed;
      drifting += right_acceleration * step;
    }

    load.follow(ahead_over_ground * std::cos(yaw) - aside_over_ground * std::sin(yaw),
                ahead_over_ground * std::sin(yaw) + aside_over_ground * std::cos(yaw));

    const double late_tilt = logged_tilt.next(tilt);
    const double late_roll = both_axes ? logged_roll.next(roll) : roll;
    // An estimator smooths what it knows of the way over ground.
    const double logged_north = lagging_north.next(speed * std::cos(yaw) - right * std::sin(yaw));
    const double logged_east = lagging_east.next(speed * std::sin(yaw) + right * std::cos(yaw));
    const double lagging_forward = logged_north * std::cos(yaw) + logged_east * std::sin(yaw);
    const double lagging_right = logged_east * std::cos(yaw) - logged_north * std::sin(yaw);
    if (k % static_cast<std::size_t>(h.steps_per_sample) == 0) {
      const auto hundredth = [](double angle) {
        return std::round(angle / degree * 100) / 100 * degree;
      };
      log.time.push_back(10 + time);
      log.roll.push_back(
          hundredth(late_roll + (h.roll_trim + h.angle_noise * normal(random)) * degree));
      log.pitch.push_back(
          hundredth(-late_tilt + h.pitch_trim * degree +
                    h.pitch_drift * degree * std::sin(2 * std::numbers::pi * time / 200) +
                    h.angle_noise * degree * normal(random)));
      log.yaw.push_back(hundredth(yaw + h.yaw_misalign * degree));
      const double forward = lagging_forward + h.speed_noise * normal(random);
      const auto rounded = [&h](double v) {
        v *= h.velocity_scale;
        return h.speed_digit > 0 ? std::round(v / h.speed_digit) * h.speed_digit : v;
      };
      log.north_velocity.push_back(
          rounded(forward * std::cos(yaw) - lagging_right * std::sin(yaw)));
      log.east_velocity.push_back(rounded(forward * std::sin(yaw) + lagging_right * std::cos(yaw)));
      log.down_velocity.push_back(rounded(down + h.speed_noise * normal(random)));
      if (h.anemometer_noise > 0) {
        const double measured = along + h.anemometer_noise * normal(random);
        log.north_wind.push_back(measured * std::cos(yaw));
        log.east_wind.push_back(measured * std::sin(yaw));
      }
    }
    speed += forward_acceleration * step;
    north += (speed * std::cos(yaw) - right * std::sin(yaw)) * step;
    east += (speed * std::sin(yaw) + right * std::cos(yaw)) * step;
    if (flown != nullptr) {
      const double aside = both_axes ? drifting - across : 0;
      const double airspeed = std::hypot(speed - along, aside);
      airspeed_sum += airspeed;
      speeding_up_sum +=
          (ahead_over_ground * (speed - along) + aside_over_ground * aside) / airspeed;
      square_sum += ahead_over_ground * ahead_over_ground + aside_over_ground * aside_over_ground;
      lift_sum += (gravity - down_acceleration) / (std::cos(tilt) * std::cos(roll));
      constexpr std::size_t second = 100;
      if ((k + 1) % second == 0) {
        flown->airspeed.push_back(std::exchange(airspeed_sum, 0) / second);
        flown->speeding_up.push_back(std::exchange(speeding_up_sum, 0) / second);
        const double mean = flown->speeding_up.back();
        flown->turning_off.push_back(
            std::sqrt(std::max(0.0, std::exchange(square_sum, 0) / second - mean * mean)));
        flown->specific_lift.push_back(std::exchange(lift_sum, 0) / second);
      }
    }
  }
  if (h.lost_rows > 0 || h.gap > 0 || h.clock_jitter > 0) record(h, log);
  return log;
}

void add_outliers(FlightLog& log, double part, std::uint64_t seed) {
  Random random(seed);
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    if (uniform(random, 0, 1) < part) log.pitch[i] += uniform(random, -0.5, 0.5);
    if (uniform(random, 0, 1) < part) {
      const double jump = uniform(random, -5, 5);
      log.north_velocity[i] += jump * std::cos(log.yaw[i]);
      log.east_velocity[i] += jump * std::sin(log.yaw[i]);
    }
  }
}

}  // namespace tethercalc::truth
