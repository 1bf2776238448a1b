#include "diagnose/power_screening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace tethercalc {
namespace {

struct Channel {
  const char* name;
  std::vector<double> PowerLog::*values;
  bool optional;
  bool may_rest;  ///< a steady reading is possible in flight
};

constexpr std::array<Channel, 8> channels{{
    {"height_m", &PowerLog::height, false, true},
    {"airspeed_m_s", &PowerLog::airspeed, false, true},
    {"ambient_temperature_C", &PowerLog::ambient_temperature_C, true, true},
    {"supply_voltage_V", &PowerLog::supply_voltage, false, true},
    {"supply_current_A", &PowerLog::supply_current, false, false},
    {"drone_voltage_V", &PowerLog::drone_voltage, true, false},
    {"bus_voltage_V", &PowerLog::bus_voltage, true, true},
    {"bus_current_A", &PowerLog::bus_current, true, false},
}};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A noisy instrument repeats its last digit by chance: with noise of one digit in about a third of
// the samples, twenty times running once in 10⁹ samples.
constexpr std::size_t stuck_run = 20;

/// Marks runs of equal readings; returns how many samples. Currents and the voltage at the drone
/// never rest in flight. Every other quantity may, so there an instrument counts as stuck only
/// where it is noisy for a good part of the log and rests but once or twice.
std::size_t mark_stuck(const std::vector<double>& x, bool may_rest, std::vector<char>& bad) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  std::size_t resting = 0;
  for (std::size_t first = 0; first < x.size();) {
    std::size_t last = first + 1;
    while (last < x.size() && x[last] == x[first]) ++last;
    if (last - first >= stuck_run && !(may_rest && x[first] == 0)) {
      runs.emplace_back(first, last);
      resting += last - first;
    }
    first = last;
  }
  constexpr double noisy_part = 0.3;
  const bool noisy_elsewhere = runs.size() <= 2 && static_cast<double>(x.size() - resting) >=
                                                       noisy_part * static_cast<double>(x.size());
  if (may_rest && !noisy_elsewhere) return 0;
  for (const auto& [first, last] : runs) {
    std::fill(bad.begin() + static_cast<std::ptrdiff_t>(first),
              bad.begin() + static_cast<std::ptrdiff_t>(last), char{1});
  }
  return resting;
}

std::size_t mark_spikes(const std::vector<double>& x, std::vector<char>& bad) {
  constexpr std::size_t half = 3;
  constexpr double limit = 8;
  if (x.size() <= 2 * half) return 0;
  std::vector<double> deviation(x.size(), 0);
  std::vector<double> window;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t begin = std::min(i < half ? 0 : i - half, x.size() - 2 * half - 1);
    window.assign(x.begin() + static_cast<std::ptrdiff_t>(begin),
                  x.begin() + static_cast<std::ptrdiff_t>(begin + 2 * half + 1));
    deviation[i] = std::abs(x[i] - median(window));
  }
  // Zeros stem from the sample being its own median, one in seven, and from ramps.
  std::vector<double> nonzero;
  std::copy_if(deviation.begin(), deviation.end(), std::back_inserter(nonzero),
               [](double d) { return d > 0; });
  if (nonzero.size() < x.size() / 10) return 0;
  const double scale = 1.4826 * median(nonzero);
  std::size_t marked = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (deviation[i] > limit * scale && !bad[i]) {
      bad[i] = 1;
      ++marked;
    }
  }
  return marked;
}

/// Replaces marked samples by the straight line between their neighbours.
void fill_in(const std::vector<double>& time, const std::vector<char>& bad,
             std::vector<double>& x) {
  const std::size_t n = x.size();
  std::size_t previous = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (!bad[i]) {
      previous = i;
      continue;
    }
    std::size_t next = i;
    while (next < n && bad[next]) ++next;
    if (previous == n && next == n) return;
    for (; i < next; ++i) {
      if (previous == n) {
        x[i] = x[next];
      } else if (next == n) {
        x[i] = x[previous];
      } else {
        const double f = (time[i] - time[previous]) / (time[next] - time[previous]);
        x[i] = x[previous] + f * (x[next] - x[previous]);
      }
    }
    --i;
  }
}

/// The channel as read `delay` seconds later on its own clock, linear between samples.
std::vector<double> advanced(const std::vector<double>& time, const std::vector<double>& x,
                             double delay) {
  std::vector<double> out(x.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = std::clamp(time[i] + delay, time.front(), time.back());
    while (k + 2 < x.size() && time[k + 1] <= at) ++k;
    const double f = (at - time[k]) / (time[k + 1] - time[k]);
    out[i] = x[k] + f * (x[k + 1] - x[k]);
  }
  return out;
}

/// Correlation of sample-to-sample changes over samples where all is well. Changes beyond ten times
/// their median size are cut to that, so that a few do not decide.
double change_correlation(const std::vector<double>& a, const std::vector<double>& b,
                          const std::vector<char>& usable) {
  std::vector<double> da, db;
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (!usable[i] || !usable[i - 1]) continue;
    const double change_a = a[i] - a[i - 1];
    const double change_b = b[i] - b[i - 1];
    if (!std::isfinite(change_a + change_b)) continue;
    da.push_back(change_a);
    db.push_back(change_b);
  }
  if (da.size() < 8) return 0;
  const auto cut = [](std::vector<double>& d) {
    std::vector<double> size(d.size());
    std::transform(d.begin(), d.end(), size.begin(), [](double x) { return std::abs(x); });
    const double limit = 10 * median(size);
    if (limit > 0) {
      for (double& x : d) x = std::clamp(x, -limit, limit);
    }
  };
  cut(da);
  cut(db);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < da.size(); ++i) {
    aa += da[i] * da[i];
    bb += db[i] * db[i];
    ab += da[i] * db[i];
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// The delay in s at which `agreement` (a correlation over about `samples` pairs) is largest; 0
/// where no delay is clearly better than none.
double best_delay(const std::function<double(double)>& agreement, std::size_t samples,
                  double interval) {
  constexpr double furthest = 12;      // s: a clock further off shows in any plot
  constexpr double negligible = 0.25;  // s: a quarter of the sampling of a 1 Hz log
  const double none = agreement(0);
  double best = 0;
  double best_value = none;
  const double step = std::max(0.5 * interval, 0.25);
  for (double delay = -furthest; delay <= furthest + 1e-9; delay += step) {
    const double value = agreement(delay);
    if (value > best_value) {
      best_value = value;
      best = delay;
    }
  }
  // Parabola through the three values around the best.
  const double before = agreement(best - step);
  const double after = agreement(best + step);
  const double bend = before - 2 * best_value + after;
  if (bend < 0) best += std::clamp(0.5 * step * (before - after) / bend, -step, step);
  // Fisher's z: atanh of a correlation has a standard deviation of 1/√n; two of them are compared,
  // and the best of some fifty chosen.
  const double z =
      std::atanh(std::min(best_value, 0.999999)) - std::atanh(std::min(none, 0.999999));
  const bool clear = z * std::sqrt(static_cast<double>(samples)) > 6 && best_value > 0.05;
  return clear && std::abs(best) > negligible ? best : 0;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), std::multiplies<>());
  return out;
}

void note_delay(const char* what, double delay, std::vector<std::string>& notes) {
  notes.push_back(fmt::format("{} lagged {:.1f} s {} the supply current; {} shifted back", what,
                              std::abs(delay), delay > 0 ? "behind" : "ahead of",
                              "the channels were"));
}

/// Puts all channels on the clock of the supply current.
void align(const PowerModel& model, const std::vector<char>& usable, PowerLog& log,
           std::vector<std::string>& notes) {
  const bool has_drone = !log.drone_voltage.empty();
  const bool has_bus = !log.bus_voltage.empty() && !log.bus_current.empty();
  const std::size_t n = log.time.size();
  const double interval = (log.time.back() - log.time.front()) / static_cast<double>(n - 1);

  const std::vector<double> supply_power = product(log.supply_voltage, log.supply_current);
  std::vector<double> bus_power;
  if (has_bus) {
    bus_power = product(log.bus_voltage, log.bus_current);
    const double delay = best_delay(
        [&](double d) {
          return change_correlation(supply_power, advanced(log.time, bus_power, d), usable);
        },
        n, interval);
    if (delay != 0) {
      note_delay("bus_voltage_V and bus_current_A", delay, notes);
      log.bus_voltage = advanced(log.time, log.bus_voltage, delay);
      log.bus_current = advanced(log.time, log.bus_current, delay);
    }
  }

  const double supply_delay = best_delay(
      [&](double d) {
        PowerLog shifted = log;
        shifted.height = advanced(log.time, log.height, d);
        shifted.airspeed = advanced(log.time, log.airspeed, d);
        return change_correlation(supply_power, motor_power(model, shifted), usable);
      },
      n, interval);
  if (supply_delay != 0) {
    note_delay("height_m and airspeed_m_s", supply_delay, notes);
    log.height = advanced(log.time, log.height, supply_delay);
    log.airspeed = advanced(log.time, log.airspeed, supply_delay);
  }

  if (has_drone) {
    const std::vector<double> resistance = loop_resistance(model, log);
    const std::vector<double> drop = product(log.supply_current, resistance);
    std::vector<double> received(n);
    std::transform(log.drone_voltage.begin(), log.drone_voltage.end(), received.begin(),
                   [](double v) { return -v; });
    const double delay = best_delay(
        [&](double d) { return change_correlation(drop, advanced(log.time, received, d), usable); },
        n, interval);
    if (delay != 0) {
      note_delay("drone_voltage_V", delay, notes);
      log.drone_voltage = advanced(log.time, log.drone_voltage, delay);
    }
  }
}

}  // namespace

ScreenedPowerLog screen_power_log(const PowerModel& model, const PowerLog& log) {
  ScreenedPowerLog screened;
  screened.log = log;
  PowerLog& clean = screened.log;
  const std::size_t n = log.time.size();

  std::array<std::vector<char>, channels.size()> bad;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::vector<double>& x = clean.*channels[c].values;
    if (x.empty()) continue;
    bad[c].assign(n, 0);
    const std::size_t stuck = mark_stuck(x, channels[c].may_rest, bad[c]);
    const std::size_t spikes = mark_spikes(x, bad[c]);
    const auto percent = [&](std::size_t k) {
      return 100.0 * static_cast<double>(k) / static_cast<double>(n);
    };
    if (stuck > 0 && channels[c].optional && 2 * stuck > n) {
      x.clear();
      bad[c].clear();
      screened.notes.push_back(fmt::format("{} is stuck for {:.0f} % of the log: not used",
                                           channels[c].name, percent(stuck)));
      continue;
    }
    if (stuck > 0) {
      screened.notes.push_back(fmt::format("{} is stuck for {:.0f} % of the log: left out there",
                                           channels[c].name, percent(stuck)));
    }
    // A corner of a climb may look like one; a handful is nothing to report.
    if (500 * spikes > n) {
      screened.notes.push_back(fmt::format("{}: {} spikes left out", channels[c].name, spikes));
    }
    fill_in(log.time, bad[c], x);
  }

  const auto usable = [&](std::initializer_list<std::vector<double> PowerLog::*> needed) {
    std::vector<char> all(n, 1);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (std::find(needed.begin(), needed.end(), channels[c].values) == needed.end()) continue;
      if (bad[c].empty()) return std::vector<char>{};
      for (std::size_t i = 0; i < n; ++i) all[i] = all[i] && !bad[c][i];
    }
    return all;
  };
  screened.tether_usable = usable({&PowerLog::supply_voltage, &PowerLog::supply_current,
                                   &PowerLog::drone_voltage, &PowerLog::height});
  screened.converter_usable = usable({&PowerLog::supply_current, &PowerLog::drone_voltage,
                                      &PowerLog::bus_voltage, &PowerLog::bus_current});
  screened.motors_usable = usable(
      {&PowerLog::bus_voltage, &PowerLog::bus_current, &PowerLog::height, &PowerLog::airspeed});

  std::vector<char> healthy(n, 1);
  for (const auto& marks : bad) {
    for (std::size_t i = 0; i < marks.size(); ++i) healthy[i] = healthy[i] && !marks[i];
  }
  align(model, healthy, clean, screened.notes);
  return screened;
}

}  // namespace tethercalc
