#include "diagnose/flight_log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

constexpr double spike_bound = 10;
/// A spike stands out from the line between its neighbours; on a flank or at a corner of honest
/// motion the neighbours differ by as much.
constexpr double spike_over_slope = 2;
/// Of the corner beside: what rounding may leave.
constexpr double on_a_line = 0.1;
/// Seconds of one and the same value. An estimator at 10 Hz with two decimals repeats itself two or
/// three times in calm flight.
constexpr double stuck_after = 1.0;

std::size_t repair_spikes(std::vector<double>& series, const SampleRange& range,
                          std::vector<bool>& bad) {
  if (range.size() < 3) return 0;
  const auto between = [&series](std::size_t i) { return (series[i - 1] + series[i + 1]) / 2; };
  std::vector<double> deviation;  // from the second sample to the last but one
  for (std::size_t i = range.first + 1; i + 1 < range.last; ++i) {
    deviation.push_back(std::abs(series[i] - between(i)));
  }
  const double bound = spike_bound * median(deviation);
  // Next to a corner of a log that was interpolated lies a sample on the line between its own
  // neighbours; next to a spike they are drawn to that, half as far.
  const auto is_corner = [&](std::size_t k) {
    const double on_line = on_a_line * deviation[k];
    return (k > 0 && deviation[k - 1] <= on_line) ||
           (k + 1 < deviation.size() && deviation[k + 1] <= on_line);
  };
  std::vector<std::size_t> spikes;
  for (std::size_t k = 0; k < deviation.size(); ++k) {
    const std::size_t i = range.first + 1 + k;
    const double slope = std::abs(series[i + 1] - series[i - 1]);
    if (deviation[k] > std::max(bound, spike_over_slope * slope) && !is_corner(k)) {
      spikes.push_back(i);
    }
  }
  for (const std::size_t i : spikes) {
    series[i] = between(i);
    bad[i] = true;
  }
  return spikes.size();
}

bool constant(const std::vector<double>& series, const SampleRange& range) {
  const auto part = std::span(series).subspan(range.first, range.size());
  return std::all_of(part.begin(), part.end(), [part](double value) { return value == part[0]; });
}

/// Seconds for which the series repeats itself for `stuck_after` or longer at a time.
double mark_stuck(const std::vector<double>& series, const std::vector<double>& time,
                  const SampleRange& range, std::vector<bool>& bad) {
  double total = 0;
  for (std::size_t i = range.first; i < range.last;) {
    std::size_t last = i;
    while (last + 1 < range.last && series[last + 1] == series[i] &&
           time[last + 1] - time[last] < stuck_after) {
      ++last;
    }
    const double duration = time[last] - time[i];
    if (duration >= stuck_after) {
      std::fill(bad.begin() + static_cast<std::ptrdiff_t>(i),
                bad.begin() + static_cast<std::ptrdiff_t>(last) + 1, true);
      total += duration;
    }
    i = last + 1;
  }
  return total;
}

}  // namespace

LogFaults repair_flight_log(FlightLog& log, const SampleRange& range) {
  LogFaults faults;
  faults.sample.assign(log.time.size(), false);
  faults.level_assumed = constant(log.roll, range);
  faults.height_unknown = constant(log.down_velocity, range);

  for (const auto& [name, series] : {std::pair{"roll", &log.roll}, std::pair{"pitch", &log.pitch},
                                     std::pair{"north velocity", &log.north_velocity},
                                     std::pair{"east velocity", &log.east_velocity},
                                     std::pair{"down velocity", &log.down_velocity}}) {
    if (constant(*series, range)) {
      // That of a flight along a meridian, or of an estimator that is stuck.
      if (series == &log.north_velocity || series == &log.east_velocity) {
        faults.notes.push_back({WarningKind::log_unchanging,
                                fmt::format("the {} never changes; it is taken as logged", name)});
      }
      continue;
    }
    if (const std::size_t spikes = repair_spikes(*series, range, faults.sample)) {
      faults.notes.push_back(
          {WarningKind::log_spikes,
           fmt::format("{} of {} samples left out: spikes in the {}", spikes, range.size(), name)});
    }
    const double stuck = mark_stuck(*series, log.time, range, faults.sample);
    if (stuck > 0) {
      faults.notes.push_back(
          {WarningKind::log_stuck,
           fmt::format(
               "{:.1f} s left out: the {} repeats one value there, as if its sensor were stuck",
               stuck, name)});
    }
  }
  return faults;
}

}  // namespace tethercalc
