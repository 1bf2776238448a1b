#include "tethercalc/io/log_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "io/logged_battery.hpp"
#include "io/logged_power.hpp"
#include "io/logged_vehicle.hpp"
#include "io/logged_wind.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/identify/drag_identification.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr double believed_step = 60;  // s, see LogSummary
constexpr double shortest_gap = 1;    // s
constexpr std::size_t most_gaps_told = 100;
constexpr double shortest_landing = 2;  // s; a drone that bounces lands later
constexpr double longest_pause = 10;    // s of a drone in the air that hardly moves

// LogEvent in ArduPilot's libraries/AP_Logger/AP_Logger.h.
constexpr double event_disarmed = 11;
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
  std::optional<LogSummary::Flight> whole;
  if (total > 0) whole = {flights.front().start, flights.back().end};
  return {total, std::move(determined_by), std::move(flights), whole};
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
    if (event == event_disarmed) land(now);
    any_ = any_ || event == event_not_landed || event == event_land_complete;
  }
  /// PX4's detector says again and again what is.
  void take_landed(bool landed, double now) {
    if (!landed && !since_) since_ = now;
    if (landed) land(now);
    any_ = true;
  }

  [[nodiscard]] bool any() const { return any_; }
  /// Whether the last flight has not been ended.
  [[nodiscard]] bool in_the_air() const { return since_.has_value(); }

  /// A last flight that nothing ended lasts to the end of the log, or to the last of what is
  /// `moving`, where that is long before.
  LogSummary::Flying finish(double log_end, const std::optional<LogSummary::Flying>& moving,
                            std::string determined_by) {
    if (since_) {
      const bool moved = moving && moving->whole && moving->whole->end > *since_;
      const bool rests = moved && log_end - moving->whole->end > longest_pause;
      if (rests) determined_by += ", and for want of the last landing the last movement";
      land(rests ? moving->whole->end : log_end);
    }
    return flying_of(std::move(flights_), std::move(determined_by));
  }

 private:
  void land(double now) {
    if (since_ && !flights_.empty() && *since_ - flights_.back().end < shortest_landing) {
      flights_.back().end = std::max(now, *since_);
    } else if (since_) {
      flights_.push_back({*since_, std::max(now, *since_)});
    }
    since_.reset();
  }

  bool any_ = false;
  std::optional<double> since_;
  std::vector<LogSummary::Flight> flights_;
};

LogSummary::Flying flying_by_speed(const FlightLogReading& reading) {
  constexpr double slowest = 0.5;         // m/s, above the velocity noise of an EKF at rest
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

LogSummary::Battery summary_of(const LoggedBattery& monitor) {
  LogSummary::Battery battery;
  battery.message = monitor.message;
  battery.instance = monitor.instance;
  battery.samples = monitor.time.size();
  battery.least_voltage = std::ranges::min(monitor.voltage);
  battery.greatest_voltage = std::ranges::max(monitor.voltage);
  battery.mean_voltage = monitor.mean_voltage();
  if (!monitor.measures_current()) return battery;
  constexpr double longest_step = 5;  // s
  double energy = 0;
  double last_power = 0;
  double last_time = 0;
  bool seen = false;
  for (std::size_t i = 0; i < monitor.time.size(); ++i) {
    const double current = monitor.current[i];
    if (!std::isfinite(current)) continue;
    const double power = monitor.voltage[i] * current;
    const double step = monitor.time[i] - last_time;
    if (seen && step > 0 && step <= longest_step) {
      energy += (power + last_power) / 2 * step;
    }
    last_power = power;
    last_time = monitor.time[i];
    battery.greatest_current = std::max(battery.greatest_current.value_or(0), current);
    seen = true;
  }
  battery.mean_current = monitor.mean_current();
  battery.energy = energy;
  return battery;
}

std::vector<LogSummary::Battery> batteries_in(const AutopilotLog& log) {
  std::vector<LogSummary::Battery> batteries;
  for (const LoggedBattery& monitor : logged_batteries(log)) {
    batteries.push_back(summary_of(monitor));
  }
  return batteries;
}

std::optional<LogSummary::Wind> wind_in(const AutopilotLog& log) {
  const std::optional<LoggedWind> wind = logged_wind(log);
  if (!wind) return std::nullopt;
  const double north = std::accumulate(wind->north.begin(), wind->north.end(), 0.0);
  const double east = std::accumulate(wind->east.begin(), wind->east.end(), 0.0);
  const double direction = std::atan2(-east, -north) / unit::degree;
  return LogSummary::Wind{wind->message,
                          std::hypot(north, east) / static_cast<double>(wind->time.size()),
                          direction < 0 ? direction + 360 : direction};
}

std::string too_short_words(double flown, double needed) {
  return fmt::format("{:.0f} s flown, {:.0f} s are needed to judge it", flown, needed);
}

/// What `diagnose --power` could do with it.
LogSummary::Use power_use(const AutopilotLog& log, const LogSummary& summary,
                          const std::optional<FlightLogReading>& flight,
                          const std::string& obstacle) {
  LogSummary::Use use{"diagnose --power", false, obstacle};
  if (!flight || !flight->log.other_vehicle.empty()) return use;
  try {
    const PowerLogReading power =
        logged_power(log, *flight, summary.flying, {.free_flight = flight->height.empty()});
    const double flown = time_without_gaps(power.log).back();
    use.possible = flown >= shortest_power_log;
    const char* const how = flight->height.empty() ? ", which tells no height (--free-flight)" : "";
    const std::vector<double>& current = power.log.bus_current;
    const bool varies =
        std::any_of(current.begin(), current.end(), [&](double x) { return x != current.front(); });
    if (use.possible && !varies) {
      return {use.command, false, "the current never changes: it is not measured"};
    }
    use.because = use.possible ? power.source + how : too_short_words(flown, shortest_power_log);
  } catch (const InputError& error) {
    use.because = error.problems().front().message;
  }
  return use;
}

/// What the commands could do with the log; `flight` where it could be read, else `obstacle`.
std::vector<LogSummary::Use> uses_of(const AutopilotLog& log, const LogSummary& summary,
                                     const std::optional<FlightLogReading>& flight,
                                     const std::string& obstacle) {
  const std::string in_the_way = !flight                              ? obstacle
                                 : !flight->log.other_vehicle.empty() ? "it is " + summary.vehicle
                                 : flight->log.time.size() > 2
                                     ? ""
                                     : "too few samples of " + flight->source;
  const auto flight_use = [&](const char* command, const auto& attempt) -> LogSummary::Use {
    if (!in_the_way.empty()) return {command, false, in_the_way};
    try {
      attempt();
      return {command, true, flight->source};
    } catch (const UnsuitableFlight& error) {
      return {command, false, error.what()};
    }
  };
  const auto identified = [&] {
    DragIdentificationOptions options;
    options.conditions.mass = 1;  // accelerations do not depend on it
    (void)identify_drag({&flight->log, 1}, options);
  };
  const auto judged = [&] {
    const double flown = judged_time(flight->log);
    if (flown < shortest_flight) throw UnsuitableFlight(too_short_words(flown, shortest_flight));
  };
  return {flight_use("drag", identified), flight_use("diagnose --flight", judged),
          power_use(log, summary, flight, in_the_way)};
}

/// What a walk through all messages tells.
struct Walk {
  Clock clock;
  FlyingByEvents events;
};

Walk walk_through(const AutopilotLog& log) {
  Walk walk;
  Clock& clock = walk.clock;  // no structured binding: clang 14 captures none
  FlyingByEvents& events = walk.events;
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
  return walk;
}

/// As the controller tells it, if it does, else by the speed of `flight`, where it could be read.
std::optional<LogSummary::Flying> flying_in(const AutopilotLog& log, Walk& walk,
                                            const std::optional<FlightLogReading>& flight) {
  std::optional<LogSummary::Flying> moving;
  if (flight) moving = flying_by_speed(*flight);
  if (!walk.events.any()) return moving;
  return walk.events.finish(*walk.clock.last, moving,
                            log.format() == LogFormat::ulog
                                ? "vehicle_land_detected"
                                : "the controller's take-off and landing events");
}

}  // namespace

std::optional<LogSummary::Flying> time_in_the_air(const AutopilotLog& log) {
  Walk walk = walk_through(log);
  std::optional<FlightLogReading> flight;
  if (!walk.events.any() || walk.events.in_the_air()) {
    try {
      flight = parse_flight_log(log);
    } catch (const InputError&) {
      flight.reset();  // nothing to tell speeds by
    }
  }
  return flying_in(log, walk, flight);
}

LogSummary summarize_log(const AutopilotLog& log) {
  LogSummary summary;
  static_cast<LogTotals&>(summary) = log.contents();
  summary.format = log.format();
  summary.dropouts = log.contents().dropouts;
  Walk walk = walk_through(log);
  const Clock& clock = walk.clock;
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
  summary.flying = flying_in(log, walk, flight);
  summary.batteries = batteries_in(log);
  summary.wind = wind_in(log);
  summary.uses = uses_of(log, summary, flight, obstacle);
  return summary;
}

}  // namespace tethercalc
