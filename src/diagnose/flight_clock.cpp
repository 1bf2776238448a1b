#include "diagnose/flight_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// Where more is missing, s, steps are counted anew: a clock that runs a little fast or slow may
/// have gained one.
constexpr double longest_counted = 1;
constexpr std::size_t fewest_samples = 50;  ///< of a piece whose step is worth fitting
/// Below this part of the step, what jitter adds to an acceleration is a hundredth of it.
constexpr double noticed = 0.02;
/// Of the step. Evenly distributed, deviations of 0.29 reach halfway to the next step.
constexpr double countable = 0.2;
/// Correlation of neighbouring deviations: rows taken late one after the other are no jitter.
constexpr double unrelated = 0.3;
constexpr double clearly = 3;  ///< standard errors

/// Even times of a log.
struct EvenTimes {
  std::vector<double> time;  ///< s, one a sample; a stamp where there are too few around it
  std::vector<long> count;   ///< of steps, in its piece of the log
  double step = 0;           ///< s
};

/// Least squares: the times of samples first ≤ i < last as a straight line over their counts.
void fit_line(const std::vector<double>& time, std::size_t first, std::size_t last,
              EvenTimes& even) {
  const auto size = static_cast<double>(last - first);
  double count = 0;
  double stamp = 0;
  for (std::size_t i = first; i < last; ++i) {
    count += static_cast<double>(even.count[i]) / size;
    stamp += time[i] / size;
  }
  double square = 0;
  double product = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double from_middle = static_cast<double>(even.count[i]) - count;
    square += from_middle * from_middle;
    product += from_middle * (time[i] - stamp);
  }
  const double step = product / square;
  even.step = step;  // that of most stamps is off where rows are missing
  for (std::size_t i = first; i < last; ++i) {
    even.time[i] = stamp + step * (static_cast<double>(even.count[i]) - count);
  }
}

/// Where an even time began whose first samples are those from `first` on, most of which follow
/// each other.
double likely_begin(const std::vector<double>& time, std::size_t first, double step) {
  constexpr std::size_t several = 9;
  std::vector<double> begins;
  for (std::size_t k = 0; k < several && first + k < time.size(); ++k) {
    begins.push_back(time[first + k] - step * static_cast<double>(k));
  }
  return median(std::move(begins));
}

/// The line, then once more with the counts that it gives: the loop takes some samples to settle.
void fit_piece(const std::vector<double>& time, std::size_t first, std::size_t last,
               EvenTimes& even) {
  if (last - first < fewest_samples) return;
  fit_line(time, first, last, even);
  for (std::size_t i = first; i < last; ++i) {
    even.count[i] += std::lround((time[i] - even.time[i]) / even.step);
  }
  fit_line(time, first, last, even);
}

/// Counts steps of an even time that follows the stamps slowly: from stamp to stamp the deviations
/// of two would count.
EvenTimes even_times(const std::vector<double>& time) {
  constexpr double followed = 0.1;  // of each deviation
  EvenTimes even{time, std::vector<long>(time.size(), 0), median_step(time)};
  std::size_t first = 0;
  double expected = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const bool begins = i == 0 || time[i] - time[i - 1] > longest_counted;
    if (begins) {
      fit_piece(time, first, i, even);
      first = i;
      expected = likely_begin(time, i, even.step);
    }
    const long steps = std::lround((time[i] - expected) / even.step);
    even.count[i] = begins ? steps : even.count[i - 1] + std::max(1L, steps);
    expected += even.step * static_cast<double>(begins ? steps : std::max(1L, steps));
    expected += followed * (time[i] - expected);
  }
  fit_piece(time, first, time.size(), even);
  return even;
}

/// Slope, through zero, of y over x, with its standard error whatever the spread of each y.
class Slope {
 public:
  void add(double x, double y) {
    xx_ += x * x;
    xy_ += x * y;
    points_.push_back({x, y});
  }
  [[nodiscard]] double value() const { return xx_ > 0 ? xy_ / xx_ : 0; }
  [[nodiscard]] double standard_error() const {
    if (!(xx_ > 0)) return infinity;
    double sum = 0;
    for (const auto& [x, y] : points_) {
      const double scatter = x * (y - value() * x);
      sum += scatter * scatter;
    }
    return std::sqrt(sum) / xx_;
  }

 private:
  double xx_ = 0;
  double xy_ = 0;
  std::vector<std::array<double, 2>> points_;
};

/// A sample that was taken later than its even time by δ shows, beside the line through its
/// neighbours, the acceleration times that. The acceleration is that of the samples next but one,
/// whose noise the line does not have.
Slope shown_by(const FlightLog& log, const EvenTimes& even) {
  Slope slope;
  const auto late = [&](std::size_t i) { return log.time[i] - even.time[i]; };
  for (std::size_t i = 2; i + 2 < log.time.size(); ++i) {
    if (even.count[i + 2] - even.count[i - 2] != 4) continue;
    const double later = late(i) - (late(i - 1) + late(i + 1)) / 2;
    for (const auto* v : {&log.north_velocity, &log.east_velocity}) {
      const double acceleration = ((*v)[i + 2] - (*v)[i - 2]) / (4 * even.step);
      slope.add(acceleration * later, (*v)[i] - ((*v)[i - 1] + (*v)[i + 1]) / 2);
    }
  }
  return slope;
}

struct Judged {
  EvenTimes even;
  ClockJitter jitter;
};

std::optional<Judged> judged(const FlightLog& log) {
  if (log.time.size() < fewest_samples) return std::nullopt;
  Judged result{even_times(log.time), {}};
  const EvenTimes& even = result.even;
  std::vector<double> late(log.time.size());
  for (std::size_t i = 0; i < late.size(); ++i) late[i] = log.time[i] - even.time[i];
  double square = 0;
  for (const double x : late) square += x * x;
  const double rms = std::sqrt(square / static_cast<double>(late.size()));
  if (!(rms > 0) || rms > countable * even.step) return std::nullopt;
  if (std::abs(autocorrelation(late, 1)) > unrelated) return std::nullopt;
  const Slope slope = shown_by(log, even);
  result.jitter = {even.step, rms, slope.value(), slope.standard_error()};
  return result;
}

}  // namespace

std::optional<ClockJitter> clock_jitter(const FlightLog& log) {
  const std::optional<Judged> found = judged(log);
  if (!found) return std::nullopt;
  return found->jitter;
}

std::optional<Warning> even_out_stamps(FlightLog& log) {
  std::optional<Judged> found = judged(log);
  if (!found) return std::nullopt;
  const ClockJitter& jitter = found->jitter;
  if (jitter.rms < noticed * jitter.step) return std::nullopt;
  // Half of the deviations is as near to none of them as to all.
  constexpr double half = 0.5;
  if (jitter.shown > half || clearly * jitter.shown_se > half) return std::nullopt;
  const bool increases = std::ranges::adjacent_find(found->even.time, std::greater_equal<>()) ==
                         found->even.time.end();
  if (!increases) return std::nullopt;
  log.time = std::move(found->even.time);
  return Warning{WarningKind::log_clock_jitter,
                 fmt::format("stamps are off by {:.1f} ms (rms) while the velocities were taken "
                             "evenly, every {:.1f} ms: the samples count at even times",
                             jitter.rms * 1e3, jitter.step * 1e3)};
}

}  // namespace tethercalc
