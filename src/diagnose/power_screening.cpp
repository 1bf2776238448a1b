#include "diagnose/power_screening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {
namespace {

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
  const std::vector<double> deviation = distance_from_neighbours(x, half);
  // Zeros stem from the sample being its own median, one in seven, and from ramps.
  std::vector<double> nonzero;
  std::copy_if(deviation.begin(), deviation.end(), std::back_inserter(nonzero),
               [](double d) { return d > 0; });
  if (nonzero.size() < x.size() / 10) return 0;
  const double scale = mad_to_sigma * median(nonzero);
  std::size_t marked = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (deviation[i] > limit * scale && !bad[i]) {
      bad[i] = 1;
      ++marked;
    }
  }
  return marked;
}

/// Values at the times `at`, which rise, on straight lines between samples; the first and the last
/// beyond them.
std::vector<double> interpolated(const std::vector<double>& time, const std::vector<double>& x,
                                 std::vector<double> at) {
  std::size_t k = 0;
  for (double& value : at) {
    const double t = std::clamp(value, time.front(), time.back());
    while (k + 2 < x.size() && time[k + 1] <= t) ++k;
    value =
        x.size() < 2 ? x[0] : x[k] + (t - time[k]) / (time[k + 1] - time[k]) * (x[k + 1] - x[k]);
  }
  return at;
}

/// Replaces marked samples by the straight line between their neighbours.
void fill_in(const std::vector<double>& time, const std::vector<char>& bad,
             std::vector<double>& x) {
  std::vector<double> good_time, good;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (bad[i]) continue;
    good_time.push_back(time[i]);
    good.push_back(x[i]);
  }
  if (good.empty() || good.size() == x.size()) return;
  const std::vector<double> filled = interpolated(good_time, good, time);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (bad[i]) x[i] = filled[i];
  }
}

/// The channel as read `delay` seconds later on its own clock.
std::vector<double> advanced(const std::vector<double>& time, const std::vector<double>& x,
                             double delay) {
  std::vector<double> at = time;
  for (double& t : at) t += delay;
  return interpolated(time, x, std::move(at));
}

/// Correlation of the changes over two samples where all is well: of a ramp they are twice those
/// over one, with the same noise. Changes beyond ten times their median size are cut to that, so
/// that a few do not decide.
double change_correlation(const std::vector<double>& a, const std::vector<double>& b,
                          const std::vector<char>& usable) {
  std::vector<double> da, db;
  for (std::size_t i = 2; i < a.size(); ++i) {
    if (!usable[i] || !usable[i - 1] || !usable[i - 2]) continue;
    const double change_a = a[i] - a[i - 2];
    const double change_b = b[i] - b[i - 2];
    if (!std::isfinite(change_a + change_b)) continue;
    da.push_back(change_a);
    db.push_back(change_b);
  }
  if (da.size() < 8) return 0;
  const auto cut = [](std::vector<double>& d) {
    std::vector<double> size = d;
    for (double& x : size) x = std::abs(x);
    const double limit = 10 * median(std::move(size));
    if (limit > 0) {
      for (double& x : d) x = std::clamp(x, -limit, limit);
    }
  };
  cut(da);
  cut(db);
  const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
  };
  const double aa = dot(da, da), bb = dot(db, db), ab = dot(da, db);
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// The delay in s at which `agreement` (a correlation over about `samples` pairs) is largest; 0
/// where no delay is clearly better than none. Tried are delays of whole sampling intervals:
/// between samples a straight line averages their noise, and channels would agree best half an
/// interval off.
double best_delay(const std::function<double(double)>& agreement, std::size_t samples,
                  double interval) {
  constexpr double furthest = 12;      // s: a clock further off shows in any plot
  constexpr double negligible = 0.25;  // s: a quarter of the sampling of a 1 Hz log
  const double step = interval * std::ceil(negligible / interval);
  const int steps = static_cast<int>(furthest / step);
  const double none = agreement(0);
  double best = 0;
  double best_value = none;
  double least_value = none;
  for (int k = -steps; k <= steps; ++k) {
    const double value = agreement(k * step);
    least_value = std::min(least_value, value);
    if (value > best_value) {
      best_value = value;
      best = k * step;
    }
  }
  // The top of the parabola through the three values around the best.
  const double before = agreement(best - step);
  const double after = agreement(best + step);
  const double bend = before - 2 * best_value + after;
  if (bend < 0) {
    const double off = std::clamp(0.5 * (before - after) / bend, -1.0, 1.0);
    best += step * off;
    best_value -= 0.25 * (before - after) * off;
  }
  // Fisher's z: atanh of a correlation has a standard deviation of 1/√n; two of them are compared,
  // and the best of some fifty chosen.
  const double z =
      std::atanh(std::min(best_value, 0.999999)) - std::atanh(std::min(none, 0.999999));
  // Where channels disagree more at some delay than they agree at any, the prediction has the wrong
  // sign, as that of a drone which flies to and fro and brakes hard: it tells no moment.
  const bool clear = z * std::sqrt(static_cast<double>(samples)) > 6 && best_value > 0.05 &&
                     best_value > -least_value;
  return clear && std::abs(best) > negligible ? best : 0;
}

/// Puts all channels on the clock of the supply current or, without one, of the bus.
void align(const PowerModel& model, const std::vector<char>& usable, PowerLog& log,
           std::vector<Warning>& notes) {
  const std::size_t n = log.time.size();
  const double interval = (log.time.back() - log.time.front()) / static_cast<double>(n - 1);
  using Member = std::vector<double> PowerLog::*;
  const bool has_supply = !log.supply_voltage.empty() && !log.supply_current.empty();
  const bool has_bus = !bus_power_of(log).empty();

  // Shifts channels to where `compared`, made of a log with them shifted, changes as `with` does.
  const auto shift = [&](const char* names, std::initializer_list<Member> channels_shifted,
                         const std::vector<double>& with, const auto& compared) {
    const auto shifted = [&](double delay) {
      PowerLog result = log;
      for (const Member x : channels_shifted) {
        if (!(log.*x).empty()) result.*x = advanced(log.time, log.*x, delay);
      }
      return result;
    };
    const double delay =
        best_delay([&](double d) { return change_correlation(with, compared(shifted(d)), usable); },
                   n, interval);
    if (delay == 0) return;
    notes.push_back({WarningKind::log_lag,
                     fmt::format("{} {} {:.1f} s {} the {}; the channels were shifted back", names,
                                 delay > 0 ? "lagged" : "ran", std::abs(delay),
                                 delay > 0 ? "behind" : "ahead of",
                                 has_supply ? "supply current" : "power at the bus")});
    log = shifted(delay);
  };
  ChainMemory memory;
  const std::vector<double> power =
      has_supply ? product(log.supply_voltage, log.supply_current) : bus_power_of(log);
  if (has_supply && has_bus) {
    shift(log.bus_power.empty() ? "bus_voltage_V and bus_current_A" : "bus_power_W",
          {&PowerLog::bus_voltage, &PowerLog::bus_current, &PowerLog::bus_power}, power,
          bus_power_of);
  }
  if (!power.empty() && (log.free_flight || !log.height.empty())) {
    shift(log.height.empty() ? "airspeed_m_s" : "height_m and airspeed_m_s",
          {&PowerLog::height, &PowerLog::airspeed, &PowerLog::acceleration_along,
           &PowerLog::acceleration_across},
          power, [&](const PowerLog& l) { return motor_power(model, l, memory.loads); });
  }
  if (has_supply && is_measured(Stage::tether, log)) {
    const std::vector<double> lost =
        product(log.supply_current, loop_resistance(model, log, memory));
    shift("drone_voltage_V", {&PowerLog::drone_voltage}, lost, [](PowerLog l) {
      for (double& v : l.drone_voltage) v = -v;
      return l.drone_voltage;
    });
  }
}

}  // namespace

std::vector<std::vector<double> PowerLog::*> compared_channels(Stage stage, const PowerLog& log) {
  std::vector<std::vector<double> PowerLog::*> channels;
  if (stage == Stage::tether) {
    return {&PowerLog::supply_voltage, &PowerLog::supply_current, &PowerLog::drone_voltage,
            &PowerLog::height};
  }
  if (stage == Stage::converter) channels = {&PowerLog::supply_current, &PowerLog::drone_voltage};
  if (stage == Stage::motors) channels = {&PowerLog::airspeed};
  if (stage == Stage::motors && !log.free_flight) channels.push_back(&PowerLog::height);
  if (log.bus_power.empty()) {
    channels.insert(channels.end(), {&PowerLog::bus_voltage, &PowerLog::bus_current});
  } else {
    channels.push_back(&PowerLog::bus_power);
  }
  return channels;
}

std::vector<std::string> channels_needed(const std::vector<Stage>& stages, bool free_flight) {
  PowerLog empty;
  empty.free_flight = free_flight;
  std::vector<std::vector<double> PowerLog::*> needed;
  for (const Stage stage : stages) {
    const auto channels = compared_channels(stage, empty);
    needed.insert(needed.end(), channels.begin(), channels.end());
  }
  std::vector<std::string> names;
  for (const PowerChannel& channel : power_channels) {
    if (contains(needed, channel.values)) names.emplace_back(channel.name);
  }
  return names;
}

bool is_measured(Stage stage, const PowerLog& log) {
  const auto channels = compared_channels(stage, log);
  return std::none_of(channels.begin(), channels.end(),
                      [&log](const auto channel) { return (log.*channel).empty(); });
}

ScreenedPowerLog screen_power_log(const PowerModel& model, const PowerLog& log) {
  ScreenedPowerLog screened;
  screened.log = log;
  PowerLog& clean = screened.log;
  const std::size_t n = log.time.size();

  std::array<std::vector<char>, power_channels.size()> bad;
  for (std::size_t c = 0; c < bad.size(); ++c) {
    const PowerChannel& channel = power_channels[c];
    std::vector<double>& x = clean.*channel.values;
    if (x.empty() || channel.of_motion) continue;
    bad[c].assign(n, 0);
    const std::size_t stuck = mark_stuck(x, channel.may_rest, bad[c]);
    const std::size_t spikes = mark_spikes(x, bad[c]);
    const bool gone = channel.optional && 2 * stuck > n;
    if (stuck > 0) {
      screened.notes.push_back(
          {WarningKind::log_stuck,
           fmt::format("{} is stuck for {:.0f} % of the log: {}", channel.name,
                       100.0 * static_cast<double>(stuck) / static_cast<double>(n),
                       gone ? "not used" : "left out there")});
    }
    if (gone) {
      x.clear();
      bad[c].clear();
      continue;
    }
    // A corner of a climb may look like one; a handful is nothing to report.
    if (500 * spikes > n) {
      screened.notes.push_back(
          {WarningKind::log_spikes,
           fmt::format("{}: {} spike{} left out", channel.name, spikes, spikes == 1 ? "" : "s")});
    }
    fill_in(log.time, bad[c], x);
  }

  for (const Stage stage : {Stage::tether, Stage::converter, Stage::motors}) {
    if (!is_measured(stage, clean)) continue;
    const auto needed = compared_channels(stage, clean);
    std::vector<char> all(n, 1);
    for (std::size_t c = 0; c < bad.size(); ++c) {
      if (!contains(needed, power_channels[c].values)) continue;
      for (std::size_t i = 0; i < n; ++i) all[i] = all[i] && !bad[c][i];
    }
    screened.usable[stage] = std::move(all);
  }

  std::vector<char> healthy(n, 1);
  for (const auto& marks : bad) {
    for (std::size_t i = 0; i < marks.size(); ++i) healthy[i] = healthy[i] && !marks[i];
  }
  align(model, healthy, clean, screened.notes);
  return screened;
}

void average_fast_samples(ScreenedPowerLog& screened) {
  constexpr double mean_over = 1;  // s
  PowerLog& log = screened.log;
  const double interval =
      (log.time.back() - log.time.front()) / static_cast<double>(log.time.size() - 1);
  if (screened.usable.size() != 1 || screened.usable.begin()->first != Stage::motors ||
      interval > mean_over / 2) {
    return;
  }
  std::vector<char>& usable = screened.usable.begin()->second;
  std::vector<std::size_t> begins;  // of each mean
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    if (begins.empty() || log.time[i] >= log.time[begins.back()] + mean_over) begins.push_back(i);
  }
  begins.push_back(log.time.size());

  std::vector<char> mean_usable;
  for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
    const auto part = std::span(usable).subspan(begins[k], begins[k + 1] - begins[k]);
    mean_usable.push_back(2 * std::count(part.begin(), part.end(), char{1}) >= std::ssize(part));
  }
  const auto average = [&](std::vector<double>& values) {
    if (values.empty()) return;
    for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
      double sum = 0;
      double count = 0;
      for (std::size_t i = begins[k]; i < begins[k + 1]; ++i) {
        if (mean_usable[k] && !usable[i]) continue;
        sum += values[i];
        ++count;
      }
      values[k] = sum / count;
    }
    values.resize(begins.size() - 1);
  };
  std::vector<double> square;
  if (!log.acceleration_along.empty() || !log.acceleration_across.empty()) {
    log.acceleration_along.resize(usable.size());
    log.acceleration_across.resize(usable.size());
    for (std::size_t i = 0; i < usable.size(); ++i) {
      square.push_back(std::pow(log.acceleration_along[i], 2) +
                       std::pow(log.acceleration_across[i], 2));
    }
  }
  average(square);
  average(log.time);
  for (const PowerChannel& channel : power_channels) average(log.*channel.values);
  for (std::size_t i = 0; i < square.size(); ++i) {
    log.acceleration_across[i] =
        std::sqrt(std::max(0.0, square[i] - std::pow(log.acceleration_along[i], 2)));
  }
  usable = std::move(mean_usable);
}

namespace {

void check_heights(const Design& design, const std::vector<double>& height,
                   const std::function<void(const std::string&)>& report) {
  const double highest = quantile(height, 0.99);
  if (highest > 1.5 * design.tether.length) {
    report(fmt::format(
        "height_m reaches {:.3g} m, the tether of the spec {:.3g} m; is the height in feet?",
        highest, design.tether.length));
  }
  // A barometer drifts by a few metres over a flight.
  constexpr double barometer_drift = 5;
  const double lowest = quantile(height, 0.01);
  if (median(height) < 0 || lowest < -barometer_drift) {
    report(
        fmt::format("height_m falls to {:.3g} m, {:.3g} m in the median; is it positive upwards "
                    "and counted from the station?",
                    lowest, median(height)));
  }
}

/// As far off as no effect's range reaches, but a unit does, or the meter of one motor among many.
void check_bus_power(const Design& design, const std::vector<double>& bus_power,
                     const std::function<void(const std::string&)>& report) {
  constexpr double few = 0.25;
  constexpr double many = 4;
  const double motors = design.drone.motor_count;
  const MotorCurve motor = motor_in_flight(design);
  const double hovering = design.drone.mass * design.flight.gravity / motors;
  const double factor = design.drone.motor_power_factor;
  const double least = factor * motors * motor.power(std::min(hovering, motor.max_thrust()));
  // A drone without a tether feeds the rest from the same bus.
  const double most =
      factor * motors * motor.power(motor.max_thrust()) + design.drone.auxiliary_power;
  // Of a log in which the drone stood on the ground for long, that of its flight.
  const double flying = quantile(bus_power, 0.9);
  if (flying < few * least || median(bus_power) > many * most) {
    report(
        fmt::format("the bus takes {:.3g} W, the motors of the spec {:.3g} to {:.3g} W; is a "
                    "current in mA, or that of one motor?",
                    flying, least, most));
  }
}

/// The power at the bus beside what the supply gives, as far as losses, loads beside the motors and
/// wrong gains (the bus's ammeter's ends at a half) can part them.
void check_bus_against_supply(const Design& design, const PowerLog& log, double bus,
                              const std::function<void(const std::string&)>& report) {
  const bool at_drone = !log.drone_voltage.empty();
  const double least = at_drone ? 0.4 : 0.1;
  constexpr double most = 3;
  const double given =
      median(product(at_drone ? log.drone_voltage : log.supply_voltage, log.supply_current));
  const double expected =
      converter_output_power(design.supply.converter, given) - design.drone.auxiliary_power;
  if (bus > 0 && !(bus < least * expected) && bus < most * given) return;
  report(fmt::format(
      "the bus takes {:.3g} W in the median where the supply gives {:.3g} W{}; a current "
      "or voltage has another unit, or is that of one motor",
      bus, given, at_drone ? " to the drone" : ""));
}

/// By how much more the power at the bus grows from the slowest fifth of the samples to the fastest
/// one than `design` has it grow, as a logarithm. Beyond any tilt its power is without end.
double growth_beyond(Design design, const PowerLog& log) {
  constexpr double fifth = 0.2;
  // How a cable hangs takes long to solve, and it has its drag on a straight line as well.
  design.tether.model = TetherModel::straight;
  const double slow = quantile(log.airspeed, fifth);
  const double fast = quantile(log.airspeed, 1 - fifth);
  HangingLoads loads;
  const std::vector<double> expected = motor_power({design}, log, loads);
  const std::vector<double> measured = bus_power_of(log);
  std::vector<double> at_slow;
  std::vector<double> at_fast;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(measured[i] > 0)) continue;
    const double beyond =
        std::isfinite(expected[i]) ? std::log(measured[i] / expected[i]) : -infinity;
    if (log.airspeed[i] <= slow) at_slow.push_back(beyond);
    if (log.airspeed[i] >= fast) at_fast.push_back(beyond);
  }
  if (at_slow.empty() || at_fast.empty()) return 0;
  return median(std::move(at_fast)) - median(std::move(at_slow));
}

/// About so many samples of the log, at equal distances.
PowerLog thinned(const PowerLog& log, std::size_t samples) {
  const std::size_t stride = std::max<std::size_t>(1, log.time.size() / samples);
  PowerLog thin;
  thin.free_flight = log.free_flight;
  const auto thin_out = [stride](const std::vector<double>& from, std::vector<double>& to) {
    for (std::size_t i = 0; i < from.size(); i += stride) to.push_back(from[i]);
  };
  thin_out(log.time, thin.time);
  for (const PowerChannel& channel : power_channels) {
    thin_out(log.*channel.values, thin.*channel.values);
  }
  return thin;
}

/// Airspeeds in km/h read as m/s: the drag of the spec would take twice the power and more, and a
/// sixth of it still too much, while at as many km/h all of it takes what was measured. Air that
/// spares the motors power at speed may hide a drag, but not that much of one.
void check_airspeeds(const Design& design, const PowerLog& whole,
                     const std::function<void(const std::string&)>& report) {
  constexpr double km_h = 1 / 3.6;
  constexpr std::size_t enough_samples = 1000;
  constexpr double twice = 0.7;        // as a logarithm
  constexpr double too_much = 0.03;    // what the median of a fifth of a log knows
  constexpr double far_better = 0.25;  // of what a sixth of the drag leaves
  constexpr double least_drag = 1.0 / 6;
  PowerLog log = thinned(whole, enough_samples);
  const double too_little = growth_beyond(design, log);
  if (too_little > -twice) return;
  Design slippery = design;
  slippery.drone.drag.front_area *= least_drag;
  slippery.drone.drag.top_area *= least_drag;
  slippery.tether.drag_coefficient *= least_drag;
  const double still_too_little = growth_beyond(slippery, log);
  if (still_too_little > -too_much) return;
  for (double& airspeed : log.airspeed) airspeed *= km_h;
  if (std::abs(growth_beyond(design, log)) > -far_better * still_too_little) return;
  report(
      fmt::format("at the airspeeds of up to {:.3g} m/s the drag of the spec would take far more "
                  "power than was measured, at as many km/h just that; is airspeed_m_s in km/h?",
                  quantile(whole.airspeed, 0.99)));
}

/// The tether takes voltage, the more the higher the current.
void check_voltages(const PowerLog& log, const std::function<void(const std::string&)>& report) {
  const double voltage = median(log.supply_voltage);
  if (log.drone_voltage.empty()) return;
  const double received = median(log.drone_voltage);
  if (!(received > 0) || received > 1.02 * voltage) {
    report(
        fmt::format("drone_voltage_V is {:.3g} V in the median and supply_voltage_V {:.3g} V: the "
                    "tether cannot raise it",
                    received, voltage));
    return;
  }
  if (log.supply_current.empty() || !(received > voltage)) return;
  // An offset or a gain is the same at all currents, or the tether's loss makes it less.
  const double low = quantile(log.supply_current, 0.25);
  const double high = quantile(log.supply_current, 0.75);
  std::vector<double> at_low;
  std::vector<double> at_high;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const double gained = log.drone_voltage[i] - log.supply_voltage[i];
    if (log.supply_current[i] <= low) at_low.push_back(gained);
    if (log.supply_current[i] >= high) at_high.push_back(gained);
  }
  constexpr double shown = 1.05;
  constexpr double in_proportion = 0.5;
  const double more = median(at_high) / median(at_low) - 1;
  if (high > shown * low && median(at_low) > 0 && more > in_proportion * (high / low - 1)) {
    report(
        "drone_voltage_V is above supply_voltage_V, by the more the higher the current; are the "
        "two exchanged?");
  }
}

/// Two ends that are measured by one instrument tell nothing of what lies between them.
void check_own_readings(const PowerLog& log,
                        const std::function<void(const std::string&)>& report) {
  struct Ends {
    const char* words;
    const std::vector<double>& from;
    const std::vector<double>& to;
  };
  for (const Ends& ends :
       {Ends{"supply_voltage_V and drone_voltage_V", log.supply_voltage, log.drone_voltage},
        Ends{"supply_voltage_V and bus_voltage_V", log.supply_voltage, log.bus_voltage},
        Ends{"supply_current_A and bus_current_A", log.supply_current, log.bus_current}}) {
    if (ends.from.empty() || ends.from != ends.to) continue;
    const auto [least, most] = std::minmax_element(ends.from.begin(), ends.from.end());
    if (*least < *most) report(fmt::format("{} are the same readings", ends.words));
  }
}

}  // namespace

void check_power_units(const Design& design, const PowerLog& log) {
  std::string problems;
  const auto report = [&problems](const std::string& problem) {
    problems += (problems.empty() ? "" : "; ") + problem;
  };
  const auto require_positive = [&](const char* name, const std::vector<double>& values,
                                    const char* unit) {
    const double middle = values.empty() ? 1 : median(values);
    if (!(middle > 0)) report(fmt::format("{} is {:.3g} {} in the median", name, middle, unit));
    return !values.empty() && middle > 0;
  };
  constexpr double longest_step = 100;  // s, in which any drone climbs and turns back
  const double step = median_step(log.time);
  if (step > longest_step) {
    report(
        fmt::format("time_s has a row every {:.3g} s in the median; is it in milliseconds?", step));
  }
  const bool has_voltage = require_positive("supply_voltage_V", log.supply_voltage, "V");
  const bool has_current = require_positive("supply_current_A", log.supply_current, "A");
  if (has_voltage) {
    const double voltage = median(log.supply_voltage);
    if (voltage > 5 * design.supply.voltage || 5 * voltage < design.supply.voltage) {
      report(fmt::format("supply_voltage_V is {:.3g} V in the median, the spec has {:.3g} V",
                         voltage, design.supply.voltage));
    }
    check_voltages(log, report);
  }
  const std::vector<double> bus_power = bus_power_of(log);
  if (!bus_power.empty() && has_voltage && has_current) {
    check_bus_against_supply(design, log, median(bus_power), report);
  } else {
    require_positive("bus_voltage_V", log.bus_voltage, "V");
    require_positive("bus_current_A", log.bus_current, "A");
    require_positive("bus_power_W", log.bus_power, "W");
  }
  if (!bus_power.empty() && problems.empty()) check_bus_power(design, bus_power, report);
  check_own_readings(log, report);
  if (problems.empty() && is_measured(Stage::motors, log)) check_airspeeds(design, log, report);
  if (!log.free_flight && !log.height.empty()) check_heights(design, log.height, report);
  if (!log.ambient_temperature_C.empty()) {
    const double ambient = median(log.ambient_temperature_C);
    if (!(ambient > -80 && ambient < 80)) {
      report(fmt::format("ambient_temperature_C is {:.3g} °C in the median; is it in kelvin?",
                         ambient));
    }
  }
  if (!problems.empty()) throw std::invalid_argument(problems);
}

}  // namespace tethercalc
