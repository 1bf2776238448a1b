#include "diagnose/flight_samples.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "identify/flight_units.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

constexpr double fast_enough = 10;  // 1/s
/// Up to twice as many are left as they are.
constexpr double too_fast = 20;  // 1/s

/// A shorter further part of a log, s, holds no independent stretch.
constexpr double shortest_further_flight = 12;

/// A drone that keeps its attitude to so much for so long, and hardly moves, stands: on the ground
/// an estimator wanders by 0.01 to 0.07° in three seconds, in the calmest hover by 0.06 to 0.24°.
constexpr double standing_range = 0.1 * unit::degree;
constexpr double standing_duration = 5;  // s
constexpr double standing_speed = 1;     // m/s, of a position estimate that wanders

constexpr double toppled_angle = 75 * unit::degree;  // as `observe` has it
constexpr double toppled_margin = 1;                 // s before and after

constexpr std::array flight_series{
    &FlightLog::time,          &FlightLog::roll,           &FlightLog::pitch,
    &FlightLog::yaw,           &FlightLog::north_velocity, &FlightLog::east_velocity,
    &FlightLog::down_velocity, &FlightLog::north_wind,     &FlightLog::east_wind};

auto iterator_at(const std::vector<double>& values, std::size_t i) {
  return values.begin() + static_cast<std::ptrdiff_t>(i);
}

/// Marks samples of `part`.
using Marks = std::vector<bool>;

void mark(Marks& marks, const SampleRange& part) {
  std::fill(marks.begin() + static_cast<std::ptrdiff_t>(part.first),
            marks.begin() + static_cast<std::ptrdiff_t>(part.last), true);
}

bool stands(const FlightLog& log, std::size_t i) {
  return std::hypot(log.north_velocity[i], log.east_velocity[i], log.down_velocity[i]) <
         standing_speed;
}

/// Stretches of `part` in which the attitude rests.
void mark_standing(const FlightLog& log, const SampleRange& part, Marks& marks) {
  for (std::size_t first = part.first; first < part.last;) {
    std::size_t last = first;
    std::array<double, 4> bounds{infinity, -infinity, infinity, -infinity};
    for (; last < part.last && stands(log, last); ++last) {
      const std::array<double, 4> wider{
          std::min(bounds[0], log.roll[last]), std::max(bounds[1], log.roll[last]),
          std::min(bounds[2], log.pitch[last]), std::max(bounds[3], log.pitch[last])};
      if (wider[1] - wider[0] > standing_range || wider[3] - wider[2] > standing_range) break;
      bounds = wider;
    }
    if (last > first && log.time[last - 1] - log.time[first] >= standing_duration) {
      mark(marks, {first, last});
      first = last;
    } else {
      ++first;
    }
  }
}

void mark_toppled(const FlightLog& log, const SampleRange& part, Marks& marks) {
  for (std::size_t i = part.first; i < part.last; ++i) {
    if (std::abs(log.pitch[i]) <= toppled_angle && std::abs(log.roll[i]) <= toppled_angle) continue;
    const auto from =
        std::lower_bound(log.time.begin(), log.time.end(), log.time[i] - toppled_margin) -
        log.time.begin();
    const auto to =
        std::upper_bound(log.time.begin(), log.time.end(), log.time[i] + toppled_margin) -
        log.time.begin();
    mark(marks, {std::max(part.first, static_cast<std::size_t>(from)),
                 std::min(part.last, static_cast<std::size_t>(to))});
  }
}

Marks either(Marks a, const Marks& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::logical_or<>());
  return a;
}

/// `log` without the samples that are marked.
FlightLog without(const FlightLog& log, const Marks& marks) {
  FlightLog rest;
  rest.other_vehicle = log.other_vehicle;
  for (auto series : flight_series) {
    for (std::size_t i = 0; i < (log.*series).size(); ++i) {
      if (!marks[i]) (rest.*series).push_back((log.*series)[i]);
    }
  }
  return rest;
}

double seconds(const FlightLog& log, const SampleRange& part) {
  return log.time[part.last - 1] - log.time[part.first];
}

/// Whether the part speeds up as it leans; nothing that cannot be observed does.
bool flies(const FlightLog& log, const SampleRange& part, const Marks& marks, double gravity) {
  if (seconds(log, part) < shortest_further_flight) return false;
  Marks other(marks.size(), true);
  for (std::size_t i = part.first; i < part.last; ++i) other[i] = marks[i];
  const FlightLog rest = without(log, other);
  if (rest.time.size() < 3) return false;
  try {
    const std::optional<Leaning> leaning =
        leaning_over_a_second(observe(rest, {0, rest.time.size()}, 0, gravity), gravity);
    return leaning && leaning->correlation > leans_to_speed_up;
  } catch (const UnsuitableFlight&) {
    return false;
  }
}

std::string times_of(const FlightLog& log, const std::vector<SampleRange>& parts) {
  std::vector<std::string> words;
  for (const SampleRange& part : parts) {
    words.push_back(
        fmt::format("{:.0f} to {:.0f} s", log.time[part.first], log.time[part.last - 1]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Seconds that the marked samples of `part` stand for.
double marked_seconds(const FlightLog& log, const SampleRange& part, const Marks& marks) {
  double sum = 0;
  for (std::size_t i = part.first; i + 1 < part.last; ++i) {
    if (marks[i] && marks[i + 1]) sum += log.time[i + 1] - log.time[i];
  }
  return sum;
}

/// Where the marked samples of first ≤ i < last led, of which the ends are not marked.
std::vector<Detour> detours(const FlightLog& log, std::size_t first, std::size_t last,
                            const Marks& marks) {
  std::vector<Detour> result;
  for (std::size_t i = first + 1; i < last; ++i) {
    if (!marks[i] && !marks[i - 1]) continue;
    if (marks[i] && !marks[i - 1]) result.emplace_back().begin = log.time[i - 1];
    const double half_step = (log.time[i] - log.time[i - 1]) / 2;
    const auto led = [&](const std::vector<double>& velocity) {
      return half_step * (velocity[i - 1] + velocity[i]);
    };
    result.back().end = log.time[i];
    result.back().north += led(log.north_velocity);
    result.back().east += led(log.east_velocity);
    result.back().up -= led(log.down_velocity);
  }
  return result;
}

}  // namespace

FlightSamples flown_samples(FlightLog log, double gravity) {
  const std::vector<SampleRange> parts = moving_parts(log);
  const SampleRange longest = moving_part(log);
  std::vector<SampleRange> flown;
  Marks standing(log.time.size(), false);
  Marks toppled = standing;
  Marks out = standing;
  for (const SampleRange& part : parts) {
    Marks still(log.time.size(), false);
    Marks over = still;
    mark_standing(log, part, still);
    mark_toppled(log, part, over);
    const Marks both = either(still, over);
    if (!(part == longest) && !flies(log, part, both, gravity)) continue;
    if (!flown.empty()) mark(out, {flown.back().last, part.first});
    flown.push_back(part);
    standing = either(standing, still);
    toppled = either(toppled, over);
    out = either(out, both);
  }

  FlightSamples samples;
  if (flown.size() > 1) {
    samples.notes.push_back(
        {WarningKind::log_flights_joined,
         fmt::format("the log holds {} flights: {}", flown.size(), times_of(log, flown))});
  }
  for (const auto& [marks, words] : {std::pair{&standing, "the drone stands still"},
                                     std::pair{&toppled, "it is tilted beyond 75°"}}) {
    double sum = 0;
    for (const SampleRange& part : flown) sum += marked_seconds(log, part, *marks);
    if (sum > 0) {
      samples.notes.push_back(
          {WarningKind::log_not_flying, fmt::format("{:.1f} s left out: {} there", sum, words)});
    }
  }
  const std::size_t first = flown.front().first;
  const std::size_t last = flown.back().last;
  const auto kept = std::count(out.begin() + static_cast<std::ptrdiff_t>(first),
                               out.begin() + static_cast<std::ptrdiff_t>(last), false);
  if (kept == 0) {
    throw UnsuitableFlight(
        fmt::format("holds no flight: from {} the drone stands still or is tilted beyond 75°, "
                    "where thrust does "
                    "not carry it",
                    times_of(log, flown)));
  }
  // What lies before and after stays for the derivatives at the ends.
  samples.range = {first, first + static_cast<std::size_t>(kept)};
  const bool whole = std::find(out.begin(), out.end(), true) == out.end();
  std::size_t from = first;
  while (out[from]) ++from;
  samples.taken_out = detours(log, from, last, out);
  samples.log = whole ? std::move(log) : without(log, out);
  return samples;
}

void average_fast_samples(FlightSamples& samples, std::vector<bool>& faulty) {
  const FlightLog& log = samples.log;
  const SampleRange range = samples.range;
  if (range.size() < 3) return;
  const double rate =
      1 / median_step({iterator_at(log.time, range.first), iterator_at(log.time, range.last)});
  if (rate <= too_fast) return;
  const auto count = static_cast<std::size_t>(rate / fast_enough);
  FlightLog means;
  means.other_vehicle = log.other_vehicle;
  std::vector<bool> any_faulty;
  for (std::size_t first = range.first; first + count <= range.last; first += count) {
    for (auto series : flight_series) {
      if ((log.*series).empty()) continue;  // was not measured
      (means.*series)
          .push_back(std::accumulate(iterator_at(log.*series, first),
                                     iterator_at(log.*series, first + count), 0.0) /
                     static_cast<double>(count));
    }
    const auto begin = faulty.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    any_faulty.push_back(std::find(begin, end, true) != end);
  }
  faulty = std::move(any_faulty);
  samples.log = std::move(means);
  samples.range = {0, samples.log.time.size()};
  samples.notes.push_back(
      {WarningKind::log_averaged,
       fmt::format("means of {} samples each are judged: a faster log knows no more of the drag",
                   count)});
}

}  // namespace tethercalc
