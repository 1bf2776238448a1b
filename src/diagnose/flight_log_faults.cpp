#include "diagnose/flight_log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tethercalc {
namespace {

constexpr std::size_t half_window = 3;
constexpr double spike_bound = 10;
/// Seconds of one and the same value. An estimator at 10 Hz with two decimals repeats itself two or
/// three times in calm flight.
constexpr double stuck_after = 1.0;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double neighbourhood_median(const std::vector<double>& series, std::size_t i,
                            const SampleRange& range) {
  const std::size_t first = i < range.first + half_window ? range.first : i - half_window;
  const std::size_t last = std::min(i + half_window + 1, range.last);
  std::array<double, 2 * half_window + 1> window{};
  const auto end = std::copy(series.begin() + static_cast<std::ptrdiff_t>(first),
                             series.begin() + static_cast<std::ptrdiff_t>(last), window.begin());
  const auto middle = window.begin() + (end - window.begin()) / 2;
  std::nth_element(window.begin(), middle, end);
  return *middle;
}

std::size_t repair_spikes(std::vector<double>& series, const SampleRange& range,
                          std::vector<bool>& bad) {
  std::vector<double> smooth(range.size());
  std::vector<double> deviation(range.size());
  for (std::size_t k = 0; k < range.size(); ++k) {
    smooth[k] = neighbourhood_median(series, range.first + k, range);
    deviation[k] = std::abs(series[range.first + k] - smooth[k]);
  }
  // In smooth motion most samples are the median of their neighbours; what the others miss it by is
  // the usual reach.
  std::vector<double> reach;
  std::copy_if(deviation.begin(), deviation.end(), std::back_inserter(reach),
               [](double d) { return d > 0; });
  if (reach.size() < 2) return 0;
  const double bound = spike_bound * median_of(std::move(reach));
  std::size_t count = 0;
  for (std::size_t k = 0; k < range.size(); ++k) {
    if (deviation[k] <= bound) continue;
    series[range.first + k] = smooth[k];
    bad[range.first + k] = true;
    ++count;
  }
  return count;
}

bool constant(const std::vector<double>& series, const SampleRange& range) {
  const auto begin = series.begin() + static_cast<std::ptrdiff_t>(range.first);
  const auto end = series.begin() + static_cast<std::ptrdiff_t>(range.last);
  return std::all_of(begin, end, [begin](double value) { return value == *begin; });
}

/// Seconds for which the series repeats itself for `stuck_after` or longer at a time.
double mark_stuck(const std::vector<double>& series, const std::vector<double>& time,
                  const SampleRange& range, std::vector<bool>& bad) {
  double total = 0;
  for (std::size_t i = range.first; i < range.last;) {
    std::size_t last = i;
    while (last + 1 < range.last && series[last + 1] == series[i]) ++last;
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

  struct Channel {
    const char* name;
    std::vector<double>& series;
  };
  const std::array<Channel, 5> channels{{{"roll", log.roll},
                                         {"pitch", log.pitch},
                                         {"north velocity", log.north_velocity},
                                         {"east velocity", log.east_velocity},
                                         {"down velocity", log.down_velocity}}};
  for (const Channel& channel : channels) {
    if (constant(channel.series, range)) continue;
    if (const std::size_t spikes = repair_spikes(channel.series, range, faults.sample)) {
      faults.notes.push_back(fmt::format("{} of {} samples left out: spikes in the {}", spikes,
                                         range.size(), channel.name));
    }
    const double stuck = mark_stuck(channel.series, log.time, range, faults.sample);
    if (stuck > 0) {
      faults.notes.push_back(
          fmt::format("{:.1f} s left out: the {} repeats one value there, as if its sensor were "
                      "stuck",
                      stuck, channel.name));
    }
  }
  return faults;
}

}  // namespace tethercalc
