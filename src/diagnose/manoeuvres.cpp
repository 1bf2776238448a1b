#include "diagnose/manoeuvres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/statistics.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double sample_step = 0.1;              // s, between samples
constexpr double turn_rate = 30 * unit::degree;  // rad/s, of the nose
/// s over which accelerations are rounded, half before and half after.
constexpr double rounding = 1.0;
/// m/s², what ArduPilot flies missions with unless told otherwise (WPNAV_ACCEL).
constexpr double autopilot_acceleration = 2.5;
/// Below this a pass takes too long to speed up.
constexpr double least_acceleration = 0.5;
/// m over home: clear of people and bushes.
constexpr double least_height = 10;
/// Of what was flown, the part of the samples that stay below a limit: single samples are gusts.
constexpr double usual = 0.99;
/// Of a tether's length, what a plan uses.
constexpr double part_of_tether = 0.95;
constexpr double least_reach = 8;    // m
constexpr double climb_height = 15;  // m, above the passes, where nothing holds the drone

/// Between −π and π.
double turned(double angle) { return std::remainder(angle, 2 * pi); }

struct Place {
  double north = 0;
  double east = 0;
  double height = 0;
};

/// A leg along a line: evenly faster, steady, evenly slower.
struct Leg {
  double length = 0;
  double speed = 0;  ///< that is reached
  double ramp = 0;   ///< s, up as down
  double duration = 0;

  [[nodiscard]] double speed_at(double time) const {
    if (ramp <= 0 || time < 0 || time > duration) return 0;
    return speed * std::min({1.0, time / ramp, (duration - time) / ramp});
  }
};

Leg leg_between(const Place& from, const Waypoint& to, double acceleration) {
  Leg leg;
  leg.length = std::hypot(to.north - from.north, to.east - from.east, to.height - from.height);
  leg.speed = std::min(to.speed, std::sqrt(acceleration * leg.length));
  leg.ramp = leg.speed / acceleration;
  leg.duration = leg.speed > 0 ? leg.length / leg.speed + leg.ramp : 0;
  return leg;
}

/// Where the drone hovers between manoeuvres.
Place above_home(const std::vector<Waypoint>& waypoints) {
  return {0, 0, waypoints.empty() ? 0 : waypoints.back().height};
}

/// A mean over `rounding`; what lies beyond the ends is zero.
std::vector<double> rounded(const std::vector<double>& values) {
  const auto half = static_cast<std::ptrdiff_t>(rounding / sample_step / 2);
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  std::vector<double> out(values.size());
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    double sum = 0;
    for (auto k = std::max(i - half, std::ptrdiff_t{0}); k <= std::min(i + half, size - 1); ++k) {
      sum += values[static_cast<std::size_t>(k)];
    }
    out[static_cast<std::size_t>(i)] = sum / static_cast<double>(2 * half + 1);
  }
  return out;
}

/// Per second, one sample before and after.
double rate(const std::vector<double>& values, std::size_t i) {
  if (i == 0 || i + 1 >= values.size()) return 0;
  return (values[i + 1] - values[i - 1]) / (2 * sample_step);
}

/// The attitude that thrust must have for the log's speeds.
void lean(FlightLog& log, const FlownBy& drone) {
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const double c = std::cos(log.yaw[i]);
    const double s = std::sin(log.yaw[i]);
    const auto ahead = [&](double north, double east) { return north * c + east * s; };
    const auto aside = [&](double north, double east) { return east * c - north * s; };
    const double north = rate(log.north_velocity, i);
    const double east = rate(log.east_velocity, i);
    const double carried = drone.gravity - rate(log.down_velocity, i);
    const double u = ahead(log.north_velocity[i], log.east_velocity[i]);
    const double v = aside(log.north_velocity[i], log.east_velocity[i]);
    const auto drag = [&](double along, double across) {
      return airframe_drag_along(drone.drag, drone.air_density, along, across,
                                 effective_area(drone.drag, 0)) /
             drone.mass;
    };
    const double tilt = std::atan((ahead(north, east) + drag(u, v)) / carried);
    log.pitch.push_back(-tilt);
    log.roll.push_back(std::atan((aside(north, east) + drag(v, u)) / carried * std::cos(tilt)));
  }
}

struct Track {
  double reach = 0;
  double highest = 0;
  double farthest = 0;  ///< from the first sample, slant
  std::vector<double> heights{};
};

/// By the integrated velocity, from the first sample on.
Track track_of(const MeasuredFlight& flight) {
  const FlightLog& log = flight.log;
  const SampleRange range = flight.range.value_or(SampleRange{0, log.time.size()});
  Track track;
  Place at;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const double passed = i > range.first ? log.time[i] - log.time[i - 1] : 0;
    at.north += log.north_velocity[i] * passed;
    at.east += log.east_velocity[i] * passed;
    if (!log.down_velocity.empty()) at.height -= log.down_velocity[i] * passed;
    track.reach = std::max(track.reach, std::hypot(at.north, at.east));
    track.highest = std::max(track.highest, at.height);
    track.farthest = std::max(track.farthest, std::hypot(at.north, at.east, at.height));
    track.heights.push_back(at.height);
  }
  return track;
}

/// What one manoeuvre is made of.
class Maker {
 public:
  Maker(const FlightLimits& limits, double heading) : limits_(limits), heading_(heading) {}

  /// The nose `nose` rad and the track `track` rad to the right of the first heading. Out to the
  /// far end and back, `climb` m higher there, `above` m over the usual height.
  void pass(double speed, double nose, double track, double climb, double above,
            const std::string& how) {
    const double steady = 4 * speed;  // m, four seconds at full speed tell more than ramps
    const double length = std::min(limits_.reach, speed * speed / limits_.acceleration + steady);
    const double height = limits_.height + above;
    Waypoint out = at(length, track, height + climb, speed, nose);
    out.hold = 2;
    Waypoint back = at(0, track, height, speed, nose);
    back.hold = 2;
    std::vector<Waypoint> way;
    if (above > 0) way.push_back(at(0, track, height, climb_speed, nose));
    way.push_back(out);
    way.push_back(back);
    if (above > 0) way.push_back(at(0, track, limits_.height, climb_speed, nose));
    const double reached = std::min(speed, std::sqrt(limits_.acceleration * length));
    add(fmt::format("{} at {:.1f} m/s, nose to {:.0f}°, {:.0f} m out and back", how, reached,
                    degrees(nose), length),
        std::move(way));
  }

  void reversals(double speed) {
    const double length = std::min(limits_.reach, speed * speed / limits_.acceleration);
    std::vector<Waypoint> way;
    for (int k = 0; k < 3; ++k) {
      way.push_back(at(length, 0, limits_.height, speed, 0));
      way.push_back(at(0, 0, limits_.height, speed, 0));
    }
    way.back().hold = 2;
    add(fmt::format("six quick reversals over {:.1f} m, nose to {:.0f}°", length, degrees(0)),
        std::move(way));
  }

  void hover_turn() {
    std::vector<Waypoint> way;
    for (int k = 0; k < 4; ++k) {
      Waypoint hover = at(0, 0, limits_.height, climb_speed, k * pi / 2);
      hover.hold = 6;
      way.push_back(hover);
    }
    add("hover at four headings, 6 s each", std::move(way));
  }

  [[nodiscard]] std::vector<Manoeuvre> made() && { return std::move(made_); }

  static constexpr double climb_speed = 1.5;  // m/s

 private:
  [[nodiscard]] double degrees(double nose) const {
    const double angle = turned(heading_ + nose) / unit::degree;
    return angle < -0.5 ? angle + 360 : std::abs(angle);
  }
  [[nodiscard]] Waypoint at(double distance, double track, double height, double speed,
                            double nose) const {
    return {distance * std::cos(heading_ + track),
            distance * std::sin(heading_ + track),
            height,
            speed,
            turned(heading_ + nose),
            0};
  }
  void add(std::string words, std::vector<Waypoint> waypoints) {
    const double duration = duration_of(waypoints, limits_, heading_);
    made_.push_back({std::move(words), std::move(waypoints), duration});
  }

  FlightLimits limits_;
  double heading_;
  std::vector<Manoeuvre> made_;
};

}  // namespace

FlightLimits flown_limits(const Design& design, std::span<const MeasuredFlight> flights) {
  FlightLimits limits;
  std::vector<double> speeds, tilts, heights;
  double farthest = 0;
  for (const MeasuredFlight& flight : flights) {
    const FlightLog& log = flight.log;
    const SampleRange range = flight.range.value_or(SampleRange{0, log.time.size()});
    for (std::size_t i = range.first; i < range.last; ++i) {
      speeds.push_back(std::hypot(log.north_velocity[i], log.east_velocity[i]));
      tilts.push_back(std::abs(log.pitch[i]));
    }
    const Track track = track_of(flight);
    limits.reach = std::max(limits.reach, track.reach);
    limits.ceiling = std::max(limits.ceiling, track.highest);
    farthest = std::max(farthest, track.farthest);
    heights.insert(heights.end(), track.heights.begin(), track.heights.end());
  }
  limits.height = std::max(least_height, median(heights));
  limits.ceiling = std::max(limits.ceiling, limits.height + climb_height);
  limits.reach = std::max(limits.reach, least_reach);
  if (speeds.empty()) return limits;
  limits.speed = std::max(quantile(speeds, usual), design.flight.airspeed);
  // Half of the tilt is for drag, wind and gusts.
  limits.acceleration =
      std::clamp(design.flight.gravity * std::tan(std::min(quantile(tilts, usual), 1.0)) / 2,
                 least_acceleration, autopilot_acceleration);
  const double length = design.tether.length;
  if (farthest > 0 && farthest <= length) {
    const double within = part_of_tether * length;
    limits.height = std::min(limits.height, 0.8 * within);
    limits.ceiling = std::clamp(limits.ceiling, limits.height, 0.9 * within);
    limits.reach =
        std::min(limits.reach, std::sqrt(within * within - limits.ceiling * limits.ceiling));
  }
  return limits;
}

std::vector<Manoeuvre> candidate_manoeuvres(const FlightLimits& limits, double heading) {
  Maker maker(limits, heading);
  for (const double part : {1.0, 0.65, 0.35}) {
    for (int k = 0; k < 4; ++k) {
      maker.pass(part * limits.speed, k * pi / 2, k * pi / 2, 0, 0, "pass");
    }
  }
  const double medium = 0.65 * limits.speed;
  maker.pass(medium, 0, pi / 2, 0, 0, "pass to the side");
  const double climb = std::min(climb_height, limits.ceiling - limits.height);
  if (climb >= 2) {
    maker.pass(medium, 0, 0, climb, 0, fmt::format("pass climbing by {:.0f} m", climb));
    maker.pass(medium, 0, 0, 0, climb, fmt::format("pass {:.0f} m higher", climb));
  }
  maker.reversals(0.4 * limits.speed);
  maker.hover_turn();
  return std::move(maker).made();
}

double duration_of(const std::vector<Waypoint>& waypoints, const FlightLimits& limits,
                   double heading) {
  double time = 0;
  Place at = above_home(waypoints);
  for (const Waypoint& next : waypoints) {
    time += std::abs(turned(next.heading - heading)) / turn_rate +
            leg_between(at, next, limits.acceleration).duration + next.hold;
    at = {next.north, next.east, next.height};
    heading = next.heading;
  }
  return time;
}

NominalFlight nominal_flight(std::span<const Manoeuvre> manoeuvres, const FlightLimits& limits,
                             double heading, const FlownBy& drone) {
  NominalFlight flight;
  FlightLog& log = flight.log;
  const auto sample = [&](std::size_t k, double yaw, double north, double east, double up) {
    log.time.push_back(sample_step * static_cast<double>(log.time.size()));
    log.yaw.push_back(yaw);
    log.north_velocity.push_back(north);
    log.east_velocity.push_back(east);
    log.down_velocity.push_back(-up);
    flight.manoeuvre.push_back(k);
  };
  const auto samples = [](double time) {
    return static_cast<int>(std::lround(time / sample_step));
  };
  double yaw = heading;
  for (std::size_t k = 0; k < manoeuvres.size(); ++k) {
    Place at = above_home(manoeuvres[k].waypoints);
    for (const Waypoint& next : manoeuvres[k].waypoints) {
      const double turn = turned(next.heading - yaw);
      const int turning = samples(std::abs(turn) / turn_rate);
      for (int i = 1; i <= turning; ++i) sample(k, yaw + turn * i / turning, 0, 0, 0);
      yaw += turn;
      const Leg leg = leg_between(at, next, limits.acceleration);
      const int flying = samples(leg.duration);
      for (int i = 0; i < flying; ++i) {
        const double along = leg.speed_at((i + 0.5) * sample_step) / leg.length;
        sample(k, yaw, along * (next.north - at.north), along * (next.east - at.east),
               along * (next.height - at.height));
      }
      for (int i = 0; i < samples(next.hold); ++i) sample(k, yaw, 0, 0, 0);
      at = {next.north, next.east, next.height};
    }
  }
  for (auto series :
       {&FlightLog::north_velocity, &FlightLog::east_velocity, &FlightLog::down_velocity}) {
    log.*series = rounded(log.*series);
  }
  lean(log, drone);
  return flight;
}

}  // namespace tethercalc
