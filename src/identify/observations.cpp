#include "tethercalc/identify/observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include "identify/flight_units.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

constexpr double moving_speed = 1.0;     // m/s: above what a hover drifts, below any useful pass
constexpr double fastest_hover = 2.0;    // m/s: a hover held by hand drifts, but not so fast
constexpr double moving_duration = 1.0;  // s: longer than a twitch of the estimator
constexpr double longest_pause = 30.0;   // s: shorter than landing, waiting and taking off again
constexpr double gap_factor = 3.0;       // tolerates two lost samples; jitter stays well below 2
constexpr double steepest_angle =
    75 * unit::degree;                      // cos is 1/4: expected acceleration amplifies errors
constexpr double fastest_multirotor = 200;  // m/s: beyond every speed on record
constexpr double lost_estimates = 0.01;     // of the samples

/// Parts of a velocity along the heading and to the right of it.
std::pair<double, double> to_heading(double yaw, double north, double east) {
  const double cos_yaw = std::cos(yaw);
  const double sin_yaw = std::sin(yaw);
  return {cos_yaw * north + sin_yaw * east, cos_yaw * east - sin_yaw * north};
}

double horizontal_speed(const FlightLog& log, std::size_t i) {
  return std::hypot(log.north_velocity[i], log.east_velocity[i]);
}

double forward_speed(const FlightLog& log, std::size_t i) {
  return to_heading(log.yaw[i], log.north_velocity[i], log.east_velocity[i]).first;
}

/// Which neighbours of a sample may be used for its derivative.
struct Neighbours {
  bool before = false;
  bool after = false;
};

/// One-sided, or at the middle of three points exact for a parabola.
double derivative(const std::vector<double>& time, const std::vector<double>& x, std::size_t i,
                  Neighbours use) {
  const auto step = [&time](std::size_t k) { return time[k + 1] - time[k]; };
  const auto slope = [&](std::size_t k) { return (x[k + 1] - x[k]) / step(k); };
  if (!use.before || !use.after) return slope(use.before ? i - 1 : i);
  const double before = step(i - 1);
  const double after = step(i);
  return (slope(i - 1) * after + slope(i) * before) / (before + after);
}

void demand_carrying_thrust(double time, double tilt, double roll) {
  if (std::abs(tilt) <= steepest_angle && std::abs(roll) <= steepest_angle) return;
  throw UnsuitableFlight(
      fmt::format("at {:.3f} s the drone pitches {:.1f}° and rolls {:.1f}°; beyond {:.0f}° thrust "
                  "no longer carries it: choose a range without this part of the log",
                  time, -tilt / unit::degree, roll / unit::degree, steepest_angle / unit::degree));
}

/// More than single flipped bits: an estimator that has lost its way goes on so.
void demand_possible_velocities(const FlightLog& log, const SampleRange& range) {
  const auto speed = [&log](std::size_t i) {
    return std::hypot(log.north_velocity[i], log.east_velocity[i], log.down_velocity[i]);
  };
  std::size_t impossible = 0;
  std::size_t fastest = range.first;
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (speed(i) > fastest_multirotor) ++impossible;
    if (speed(i) > speed(fastest)) fastest = i;
  }
  if (static_cast<double>(impossible) <= lost_estimates * static_cast<double>(range.size())) return;
  throw UnsuitableFlight(fmt::format(
      "at {:.3f} s the logged velocity is {:.0f} m/s, {:.0f} m/s of it {}, which no multirotor "
      "flies: the estimator has diverged; choose a range before it did",
      log.time[fastest], speed(fastest), std::abs(log.down_velocity[fastest]),
      log.down_velocity[fastest] > 0 ? "downward" : "upward"));
}

}  // namespace

double median_step(const std::vector<double>& time) {
  std::vector<double> steps(time.size());
  std::adjacent_difference(time.begin(), time.end(), steps.begin());
  steps.erase(steps.begin());  // the first time itself
  return ordered(std::move(steps), time.size() / 2 - 1);
}

double shortest_gap(const std::vector<double>& time) { return gap_factor * median_step(time); }

void validate(const FlightLog& log) {
  if (!log.other_vehicle.empty()) {
    throw UnsuitableFlight(fmt::format(
        "this is a log of {}; only a multirotor's attitude tells where its thrust points",
        log.other_vehicle));
  }
  const std::size_t size = log.time.size();
  const auto is_wind = [&log](const std::vector<double>* values) {
    return values == &log.north_wind || values == &log.east_wind;
  };
  for (const auto& [name, values] :
       {std::pair{"time", &log.time}, std::pair{"roll", &log.roll}, std::pair{"pitch", &log.pitch},
        std::pair{"yaw", &log.yaw}, std::pair{"north velocity", &log.north_velocity},
        std::pair{"east velocity", &log.east_velocity},
        std::pair{"down velocity", &log.down_velocity}, std::pair{"north wind", &log.north_wind},
        std::pair{"east wind", &log.east_wind}}) {
    if (values->size() != size && !(values->empty() && is_wind(values))) {
      throw UnsuitableFlight(fmt::format("the flight log has {} values of {} for {} times",
                                         values->size(), name, size));
    }
    const auto bad = std::find_if_not(values->begin(), values->end(),
                                      [](double value) { return std::isfinite(value); });
    if (bad != values->end()) {
      throw UnsuitableFlight(
          fmt::format("sample {} of the flight log has a {} that is not a number",
                      bad - values->begin() + 1, name));
    }
  }
  if (size < 3) {
    throw UnsuitableFlight(
        fmt::format("the flight log has {} samples; accelerations need at least 3", size));
  }
  const auto back = std::ranges::adjacent_find(log.time, std::greater_equal<>());
  if (back != log.time.end()) {
    throw UnsuitableFlight(
        fmt::format("time does not increase from {:.6f} s to {:.6f} s at sample {}", *back,
                    *(back + 1), back - log.time.begin() + 2));
  }
}

SampleRange range_in_seconds(const FlightLog& log, double from, double to) {
  validate(log);
  const auto begin = log.time.begin();
  const auto first = std::lower_bound(begin, log.time.end(), from);
  const auto last = std::upper_bound(begin, log.time.end(), to);
  if (!(from <= to) || first >= last) {
    const std::string wanted = !std::isfinite(to)     ? fmt::format("from {} s on", from)
                               : !std::isfinite(from) ? fmt::format("up to {} s", to)
                                                      : fmt::format("from {} s to {} s", from, to);
    throw UnsuitableFlight(fmt::format("no sample {}; the log runs from {:.3f} s to {:.3f} s",
                                       wanted, log.time.front(), log.time.back()));
  }
  return {static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin)};
}

SampleRange range_in_percent(const FlightLog& log, double from, double to) {
  validate(log);
  if (!(0 <= from && from < to && to <= 100)) {
    throw UnsuitableFlight(fmt::format(
        "the range {} % to {} % of the log must satisfy 0 <= from < to <= 100", from, to));
  }
  const auto size = static_cast<double>(log.time.size());
  const SampleRange range{static_cast<std::size_t>(size * (from / 100)),
                          static_cast<std::size_t>(size * (to / 100))};
  if (range.first >= range.last) {
    throw UnsuitableFlight(fmt::format("no sample from {} % to {} % of a log of {} samples", from,
                                       to, log.time.size()));
  }
  return range;
}

SampleRange select_range(const FlightLog& log, std::optional<LogPosition> from,
                         std::optional<LogPosition> to) {
  const auto range_of = [&log](std::optional<LogPosition> lower, std::optional<LogPosition> upper) {
    const bool percent = (lower && lower->percent) || (upper && upper->percent);
    if (percent) {
      return range_in_percent(log, lower ? lower->value : 0, upper ? upper->value : 100);
    }
    return range_in_seconds(log, lower ? lower->value : -infinity, upper ? upper->value : infinity);
  };
  if (!from || !to || from->percent == to->percent) return range_of(from, to);
  const SampleRange range{range_of(from, std::nullopt).first, range_of(std::nullopt, to).last};
  if (range.first >= range.last) {
    throw UnsuitableFlight(fmt::format("the range ends at {:.3f} s, before it begins at {:.3f} s",
                                       log.time[range.last - 1], log.time[range.first]));
  }
  return range;
}

std::vector<SampleRange> moving_parts(const FlightLog& log) {
  validate(log);
  const auto& time = log.time;
  std::vector<SampleRange> parts;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (horizontal_speed(log, i) < moving_speed) continue;
    SampleRange stretch{i, i + 1};
    while (stretch.last < time.size() && horizontal_speed(log, stretch.last) >= moving_speed) {
      ++stretch.last;
    }
    i = stretch.last;
    if (time[stretch.last - 1] - time[stretch.first] < moving_duration) continue;
    const bool continues =
        !parts.empty() && time[stretch.first] - time[parts.back().last - 1] < longest_pause;
    if (continues) {
      parts.back().last = stretch.last;
    } else {
      parts.push_back(stretch);
    }
  }
  if (parts.empty()) {
    throw UnsuitableFlight(
        fmt::format("the drone never flies at {} m/s over ground for {} s: there is no "
                    "drag to learn from; give a flight with passes in both directions, or a range",
                    moving_speed, moving_duration));
  }
  return parts;
}

SampleRange moving_part(const FlightLog& log) {
  const std::vector<SampleRange> parts = moving_parts(log);
  return *std::max_element(parts.begin(), parts.end(),
                           [&log](const SampleRange& a, const SampleRange& b) {
                             const auto duration = [&log](const SampleRange& part) {
                               return log.time[part.last - 1] - log.time[part.first];
                             };
                             return duration(a) < duration(b);
                           });
}

double pitch_offset_from_hover(const FlightLog& hover) {
  validate(hover);
  const std::size_t size = hover.time.size();
  std::vector<double> speeds(size);
  for (std::size_t i = 0; i < size; ++i) speeds[i] = std::abs(forward_speed(hover, i));
  // The way to the place of hover and back may be part of it.
  const double typical =
      ordered(std::move(speeds), static_cast<std::size_t>(0.8 * static_cast<double>(size)));
  if (typical > fastest_hover) {
    throw UnsuitableFlight(
        fmt::format("is no hover: a fifth of the time the drone flies forward or backward at more "
                    "than {:.1f} m/s, leaning as it does; its mean pitch is no offset",
                    typical));
  }
  return std::accumulate(hover.pitch.begin(), hover.pitch.end(), 0.0) /
         static_cast<double>(hover.pitch.size());
}

Observations observe(const FlightLog& log, const SampleRange& range, double pitch_offset,
                     double gravity, Kinematics kinematics) {
  validate(log);
  const std::size_t size = log.time.size();
  if (range.first >= range.last || range.last > size) {
    throw UnsuitableFlight(fmt::format("samples {} to {} are no part of a log of {} samples",
                                       range.first + 1, range.last, size));
  }
  demand_possible_velocities(log, range);

  // One sample beyond the range on either side for the derivatives.
  std::vector<double> forward(size);
  std::vector<double> right(size);
  const std::size_t begin = range.first == 0 ? 0 : range.first - 1;
  const std::size_t end = std::min(range.last + 1, size);
  for (std::size_t i = begin; i < end; ++i) {
    std::tie(forward[i], right[i]) =
        to_heading(log.yaw[i], log.north_velocity[i], log.east_velocity[i]);
  }

  const double longest_step = shortest_gap(log.time);
  const auto connected = [&log, longest_step](std::size_t i) {
    return log.time[i + 1] - log.time[i] <= longest_step;
  };

  Observations out;
  out.kinematics = kinematics;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Neighbours use{i > 0 && connected(i - 1), i + 1 < size && connected(i)};
    if (!use.before && !use.after) continue;
    const double tilt = pitch_offset - log.pitch[i];
    demand_carrying_thrust(log.time[i], tilt, log.roll[i]);
    const double down_acceleration = derivative(log.time, log.down_velocity, i, use);
    out.time.push_back(log.time[i]);
    out.tilt.push_back(tilt);
    out.roll.push_back(log.roll[i]);
    out.yaw.push_back(log.yaw[i]);
    out.forward_speed.push_back(forward[i]);
    out.right_speed.push_back(right[i]);
    out.down_speed.push_back(log.down_velocity[i]);
    if (!log.north_wind.empty() && !log.east_wind.empty()) {
      const auto [ahead, aside] = to_heading(log.yaw[i], log.north_wind[i], log.east_wind[i]);
      out.forward_wind.push_back(ahead);
      out.right_wind.push_back(aside);
    }
    const auto [ahead, aside] =
        to_heading(log.yaw[i], derivative(log.time, log.north_velocity, i, use),
                   derivative(log.time, log.east_velocity, i, use));
    const bool exact = kinematics == Kinematics::exact;
    out.forward_acceleration.push_back(exact ? ahead : derivative(log.time, forward, i, use));
    out.right_acceleration.push_back(aside);
    out.down_acceleration.push_back(down_acceleration);
    const double published = exact ? 1 : std::cos(log.roll[i]);
    out.expected_acceleration.push_back((gravity - down_acceleration) * std::tan(tilt) / published);
  }
  return out;
}

std::vector<double> forward_drag_over_mass(const Observations& flight) {
  std::vector<double> drag(flight.size());
  for (std::size_t i = 0; i < drag.size(); ++i) {
    drag[i] = flight.expected_acceleration[i] - flight.forward_acceleration[i];
  }
  return drag;
}

}  // namespace tethercalc
