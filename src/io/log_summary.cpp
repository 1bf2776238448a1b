#include "tethercalc/io/log_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "io/logged_vehicle.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr double believed_step = 60;  // s, see LogSummary
constexpr double shortest_gap = 1;    // s
constexpr std::size_t most_gaps_told = 100;

// LogEvent in ArduPilot's libraries/AP_Logger/AP_Logger.h.
constexpr double event_land_complete = 18;
constexpr double event_not_landed = 28;

struct TimesOfMessage {
  std::size_t count = 0;
  double first = 0;
  double last = 0;
  double latest_seen = 0;  // of the message before
  double longest_gap = 0;
};

/// The stretches of time in which messages were written, in whatever order they stand in the log:
/// a PX4 log begins with what was published long before, each with its own time.
class WrittenTimes {
 public:
  void take(double time) {
    if (last_ != ends_.end() && time >= last_->first && time <= last_->second) return;
    // The first stretch that begins behind this moment, and the one before it.
    auto next = ends_.upper_bound(time);
    const bool joins_before =
        next != ends_.begin() && time - std::prev(next)->second <= shortest_gap;
    last_ = joins_before ? std::prev(next) : ends_.emplace_hint(next, time, time);
    last_->second = std::max(last_->second, time);
    next = std::next(last_);
    if (next == ends_.end() || next->first - last_->second > shortest_gap) return;
    last_->second = std::max(last_->second, next->second);
    ends_.erase(next);
  }

  /// Between them, in order, the first that are told, and how many there are.
  [[nodiscard]] std::pair<std::vector<LogSummary::Gap>, std::size_t> gaps() const {
    std::vector<LogSummary::Gap> out;
    for (auto at = ends_.begin(); at != ends_.end() && std::next(at) != ends_.end(); ++at) {
      if (out.size() == most_gaps_told) break;
      out.push_back({at->second, std::next(at)->first - at->second});
    }
    return {std::move(out), ends_.empty() ? 0 : ends_.size() - 1};
  }

 private:
  std::map<double, double> ends_;  // of each stretch, by its beginning
  std::map<double, double>::iterator last_ = ends_.end();
};

/// Follows the log's clock and keeps what belongs to it.
class Clock {
 public:
  void take(const std::string& message, double time) {
    if (first && std::abs(time - now_) <= believed_step) {
      disbelieve_waiting();
      believe(message, time);
    } else if (waiting_ && std::abs(time - waiting_->second) <= believed_step) {
      believe(waiting_->first, waiting_->second);
      waiting_.reset();
      believe(message, time);
    } else {
      disbelieve_waiting();
      waiting_.emplace(message, time);
    }
  }

  void finish() {
    if (!first && waiting_) {
      believe(waiting_->first, waiting_->second);
      waiting_.reset();
    }
    disbelieve_waiting();
  }

  [[nodiscard]] double now() const { return now_; }

  std::map<std::string, TimesOfMessage, std::less<>> times;
  std::optional<double> first;
  std::optional<double> last;
  WrittenTimes written;
  std::size_t disbelieved = 0;

 private:
  void disbelieve_waiting() {
    if (waiting_) ++disbelieved;
    waiting_.reset();
  }

  void believe(const std::string& message, double time) {
    written.take(time);
    // Messages are written a little out of order; only a restart sets the clock back.
    now_ = !first || now_ - time > believed_step ? time : std::max(now_, time);
    first = first ? std::min(*first, time) : time;
    last = last ? std::max(*last, time) : time;

    TimesOfMessage& own =
        times.try_emplace(message, TimesOfMessage{0, time, time, time, 0}).first->second;
    ++own.count;
    own.first = std::min(own.first, time);
    own.last = std::max(own.last, time);
    own.longest_gap = std::max(own.longest_gap, time - own.latest_seen);
    own.latest_seen = time;
  }

  double now_ = 0;
  std::optional<std::pair<std::string, double>> waiting_;
};

LogSummary::Flying flying_of(std::vector<LogSummary::Flight> flights, std::string determined_by) {
  double total = 0;
  for (const LogSummary::Flight& flight : flights) total += flight.end - flight.start;
  return {total, std::move(determined_by), std::move(flights)};
}

/// Time in the air by the controller's events.
class FlyingByEvents {
 public:
  void take(double event, double now, double log_start) {
    if (event == event_not_landed && !since_) since_ = now;
    if (event == event_land_complete) {
      if (!since_ && !any_) since_ = log_start;
      land(now);
    }
    any_ = any_ || event == event_not_landed || event == event_land_complete;
  }
  /// PX4's detector says again and again what is.
  void take_landed(bool landed, double now) {
    if (!landed && !since_) since_ = now;
    if (landed) land(now);
    any_ = true;
  }
  std::optional<LogSummary::Flying> finish(double log_end, std::string determined_by) {
    if (!any_) return std::nullopt;
    land(log_end);
    return flying_of(std::move(flights_), std::move(determined_by));
  }

 private:
  void land(double now) {
    if (since_) flights_.push_back({*since_, std::max(now, *since_)});
    since_.reset();
  }

  bool any_ = false;
  std::optional<double> since_;
  std::vector<LogSummary::Flight> flights_;
};

LogSummary::Flying flying_by_speed(const FlightLogReading& reading) {
  constexpr double slowest = 0.5;         // m/s, above the velocity noise of an EKF at rest
  constexpr double longest_pause = 10;    // s
  constexpr double shortest_stretch = 2;  // s
  const FlightLog& log = reading.log;
  std::vector<LogSummary::Flight> flights;
  std::optional<LogSummary::Flight> stretch;
  const auto finish_stretch = [&] {
    if (stretch && stretch->end - stretch->start >= shortest_stretch) flights.push_back(*stretch);
    stretch.reset();
  };
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const double speed =
        std::hypot(log.north_velocity[i], log.east_velocity[i], log.down_velocity[i]);
    if (speed < slowest) continue;
    if (stretch && log.time[i] - stretch->end > longest_pause) finish_stretch();
    if (!stretch) stretch = LogSummary::Flight{log.time[i], log.time[i]};
    stretch->end = log.time[i];
  }
  finish_stretch();
  LogSummary::Flying flying = flying_of(
      std::move(flights), fmt::format("moving at {} m/s or more in {}, for want of take-off events",
                                      slowest, reading.source));
  flying.flights.clear();  // a hover between two of them is no landing
  return flying;
}

/// What the summary of a message needs of its type.
struct FieldsInUse {
  std::optional<LogTime> time;
  const LogField* event = nullptr;
  const LogField* landed = nullptr;
};

std::vector<LogSummary::Message> message_table(const AutopilotLog& log, const Clock& clock) {
  const LogContents& contents = log.contents();
  std::map<std::string, LogSummary::Message> by_name;
  for (const auto& type : contents.types) {
    if (type.count > 0) by_name[type.type.name].count += type.count;
  }
  std::vector<LogSummary::Message> table;
  for (auto& [name, message] : by_name) {
    message.name = name;
    for (const LogField& field : contents.find(name)->fields) {
      message.fields.push_back(field.name);
      message.units.push_back(field.unit);
    }
    message.instances = log.instances(name);
    if (const auto found = clock.times.find(name); found != clock.times.end()) {
      const TimesOfMessage& times = found->second;
      message.first_time = times.first;
      message.last_time = times.last;
      if (times.count > 1) message.longest_gap = times.longest_gap;
      if (times.last > times.first) {
        message.rate = static_cast<double>(times.count - 1) / (times.last - times.first);
      }
    }
    table.push_back(std::move(message));
  }
  return table;
}

/// Where a log tells voltage and current.
struct BatteryFields {
  const char* message;
  const char* voltage;
  const char* current;
};
constexpr std::array<BatteryFields, 4> battery_fields = {
    {{"BAT", "Volt", "Curr"},
     {"CURR", "Volt", "Curr"},
     {"CURR2", "Volt", "Curr"},
     {"battery_status", "voltage_v", "current_a"}}};

/// Integers hold hundredths (ArduPilot until 2015).
double unit_of(const LogMessageType& type, const char* field) {
  const LogField* const found = type.find_number(field);
  return found != nullptr && (found->kind == 'h' || found->kind == 'H') ? 0.01 : 1;
}

std::optional<LogSummary::Battery> battery_in(const AutopilotLog& log, const BatteryFields& from,
                                              std::optional<int> instance) {
  const LogMessageType& type = *log.contents().find(from.message);
  const std::vector<std::string> fields = {from.voltage, from.current};
  const LogSeries series = log.series(from.message, fields, instance);
  LogSummary::Battery battery;
  battery.message = from.message;
  battery.instance = instance;
  constexpr double longest_step = 5;  // s
  double voltages = 0;
  double currents = 0;
  double energy = 0;
  double last_power = 0;
  double last_time = 0;
  std::size_t with_current = 0;
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double voltage = series.columns[0][i] * unit_of(type, from.voltage);
    const double current = series.columns[1][i] * unit_of(type, from.current);
    constexpr double highest = 1000;  // V and A that a drone can have
    if (!(voltage > 0 && voltage < highest)) continue;
    battery.least_voltage =
        battery.samples == 0 ? voltage : std::min(battery.least_voltage, voltage);
    battery.greatest_voltage = std::max(battery.greatest_voltage, voltage);
    voltages += voltage;
    ++battery.samples;
    if (!(current >= 0 && current < highest)) continue;  // PX4 writes -1 where it is not known
    const double power = voltage * current;
    const double step = series.time[i] - last_time;
    if (with_current > 0 && step > 0 && step <= longest_step)
      energy += (power + last_power) / 2 * step;
    last_power = power;
    last_time = series.time[i];
    currents += current;
    battery.greatest_current = std::max(battery.greatest_current.value_or(0), current);
    ++with_current;
  }
  if (battery.samples == 0) return std::nullopt;
  battery.mean_voltage = voltages / static_cast<double>(battery.samples);
  // All zero: there is no sensor.
  if (with_current > 0 && currents > 0) {
    battery.mean_current = currents / static_cast<double>(with_current);
    battery.energy = energy;
  } else {
    battery.greatest_current.reset();
  }
  return battery;
}

std::vector<LogSummary::Battery> batteries_in(const AutopilotLog& log) {
  std::vector<LogSummary::Battery> batteries;
  for (const BatteryFields& from : battery_fields) {
    if (log.contents().count(from.message) == 0) continue;
    const std::vector<int> instances = log.instances(from.message);
    if (instances.empty()) {
      if (auto found = battery_in(log, from, std::nullopt)) batteries.push_back(std::move(*found));
    }
    for (const int instance : instances) {
      if (auto found = battery_in(log, from, instance)) batteries.push_back(std::move(*found));
    }
  }
  return batteries;
}

std::optional<LogSummary::Wind> wind_in(const AutopilotLog& log) {
  struct WindFields {
    const char* message;
    std::vector<std::string> north_and_east;
  };
  const std::array<WindFields, 5> all = {
      {{"XKF2", {"VWN", "VWE"}},
       {"NKF2", {"VWN", "VWE"}},
       {"EKF2", {"VWN", "VWE"}},
       {"wind", {"windspeed_north", "windspeed_east"}},
       {"wind_estimate", {"windspeed_north", "windspeed_east"}}}};
  for (const WindFields& from : all) {
    const auto columns = log.columns(from.message, from.north_and_east, 0);
    double north = 0;
    double east = 0;
    bool is_guessed = false;
    std::size_t count = 0;
    for (std::size_t i = 0; i < columns[0].size(); ++i) {
      constexpr double fastest = 100;  // m/s; more is damage
      if (!(std::hypot(columns[0][i], columns[1][i]) < fastest)) continue;
      north += columns[0][i];
      east += columns[1][i];
      is_guessed = is_guessed || columns[0][i] != 0 || columns[1][i] != 0;
      ++count;
    }
    if (!is_guessed) continue;  // estimators that do not guess it write zeros
    const double direction = std::atan2(-east, -north) / unit::degree;
    return LogSummary::Wind{from.message, std::hypot(north, east) / static_cast<double>(count),
                            direction < 0 ? direction + 360 : direction};
  }
  return std::nullopt;
}

/// What the commands could do with the log; `flight` where it could be read, else `obstacle`.
std::vector<LogSummary::Use> uses_of(const LogSummary& summary,
                                     const std::optional<FlightLogReading>& flight,
                                     const std::string& obstacle) {
  const bool is_flown = flight && flight->log.other_vehicle.empty() && flight->log.time.size() > 2;
  const std::string because = !flight                              ? obstacle
                              : !flight->log.other_vehicle.empty() ? "it is " + summary.vehicle
                              : is_flown                           ? flight->source
                                         : "too few samples of " + flight->source;
  const auto with_current = std::ranges::find_if(
      summary.batteries, [](const auto& battery) { return battery.mean_current.has_value(); });
  const std::string power = summary.batteries.empty() ? "no voltage and no current in the log"
                            : with_current == summary.batteries.end()
                                ? "no current in " + summary.batteries.front().message
                                : fmt::format("needs CSV; voltage and current are in {} (--csv {})",
                                              with_current->message, with_current->message);
  return {{"drag", is_flown, because},
          {"diagnose --flight", is_flown, because},
          {"diagnose --power", false, power}};
}

}  // namespace

LogSummary summarize_log(const AutopilotLog& log) {
  LogSummary summary;
  static_cast<LogTotals&>(summary) = log.contents();
  summary.format = log.format();
  summary.dropouts = log.contents().dropouts;
  Clock clock;
  FlyingByEvents events;
  std::map<const LogMessageType*, FieldsInUse> fields_of;
  const LogMessageType* last_type = nullptr;
  FieldsInUse* last_fields = nullptr;
  log.for_each([&](const LogMessageType& type, const std::byte* message) {
    if (&type != last_type) {
      const auto [entry, is_new] = fields_of.try_emplace(&type);
      last_type = &type;
      last_fields = &entry->second;
      if (is_new) {
        *last_fields = {
            time_of(type), type.name == "EV" ? type.find_number("Id") : nullptr,
            type.name == "vehicle_land_detected" ? type.find_number("landed") : nullptr};
      }
    }
    const FieldsInUse& fields = *last_fields;
    if (fields.time) {
      clock.take(type.name,
                 field_value(message, fields.time->field) / fields.time->counts_per_second);
    }
    if (fields.event != nullptr && clock.first) {
      events.take(field_value(message, *fields.event), clock.now(), *clock.first);
    }
    if (fields.landed != nullptr && clock.first) {
      events.take_landed(field_value(message, *fields.landed) != 0, clock.now());
    }
  });
  clock.finish();

  summary.types = message_table(log, clock);
  summary.first_time = clock.first;
  summary.last_time = clock.last;
  std::tie(summary.gaps, summary.gap_count) = clock.written.gaps();
  summary.implausible_times = clock.disbelieved;
  LoggedVehicle vehicle = logged_vehicle(log);
  summary.firmware = std::move(vehicle.firmware);
  summary.vehicle = std::move(vehicle.kind);
  std::optional<FlightLogReading> flight;
  std::string obstacle;
  try {
    flight = parse_flight_log(log);
  } catch (const InputError& error) {
    obstacle = error.problems().front().message;
  }
  if (clock.last) {
    summary.flying =
        events.finish(*clock.last, log.format() == LogFormat::ulog
                                       ? "vehicle_land_detected"
                                       : "the controller's take-off and landing events");
  }
  if (!summary.flying && flight) summary.flying = flying_by_speed(*flight);
  summary.batteries = batteries_in(log);
  summary.wind = wind_in(log);
  summary.uses = uses_of(summary, flight, obstacle);
  return summary;
}

}  // namespace tethercalc
