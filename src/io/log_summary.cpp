#include "tethercalc/io/log_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"

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
  std::vector<LogSummary::Gap> gaps;
  std::size_t gap_count = 0;
  std::size_t disbelieved = 0;

 private:
  void disbelieve_waiting() {
    if (waiting_) ++disbelieved;
    waiting_.reset();
  }

  void believe(const std::string& message, double time) {
    if (first && time - now_ > shortest_gap) {
      ++gap_count;
      if (gaps.size() < most_gaps_told) gaps.push_back({now_, time - now_});
    }
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
  std::optional<LogSummary::Flying> finish(double log_end) {
    if (!any_) return std::nullopt;
    land(log_end);
    return LogSummary::Flying{total_, "the controller's take-off and landing events"};
  }

 private:
  void land(double now) {
    if (since_) total_ += std::max(0.0, now - *since_);
    since_.reset();
  }

  bool any_ = false;
  std::optional<double> since_;
  double total_ = 0;
};

std::optional<LogSummary::Flying> flying_by_speed(std::span<const std::byte> content) {
  constexpr double slowest = 0.5;         // m/s, above the velocity noise of an EKF at rest
  constexpr double longest_pause = 10;    // s
  constexpr double shortest_stretch = 2;  // s
  FlightLogReading reading;
  try {
    reading = parse_flight_log(content, "", {});
  } catch (const InputError&) {
    return std::nullopt;  // no estimator in the log
  }
  const FlightLog& log = reading.log;
  double total = 0;
  std::optional<std::pair<double, double>> stretch;
  const auto finish_stretch = [&] {
    if (stretch && stretch->second - stretch->first >= shortest_stretch) {
      total += stretch->second - stretch->first;
    }
    stretch.reset();
  };
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const double speed =
        std::hypot(log.north_velocity[i], log.east_velocity[i], log.down_velocity[i]);
    if (speed < slowest) continue;
    if (stretch && log.time[i] - stretch->second > longest_pause) finish_stretch();
    if (!stretch) stretch.emplace(log.time[i], log.time[i]);
    stretch->second = log.time[i];
  }
  finish_stretch();
  return LogSummary::Flying{
      total, fmt::format("moving at {} m/s or more in {}, for want of take-off events", slowest,
                         reading.source)};
}

/// What the summary of a message needs of its format.
struct FieldsInUse {
  std::optional<DataFlashTime> time;
  const DataFlashField* event = nullptr;
};

std::vector<LogSummary::Message> message_table(const DataFlashContents& contents,
                                               const Clock& clock) {
  std::map<std::string, LogSummary::Message> by_name;
  for (const auto& type : contents.types) {
    if (type.count > 0) by_name[type.format.name].count += type.count;
  }
  std::vector<LogSummary::Message> table;
  for (auto& [name, message] : by_name) {
    message.name = name;
    for (const auto& field : contents.find(name)->fields) message.fields.push_back(field.name);
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

}  // namespace

LogSummary summarize_log(std::span<const std::byte> log) {
  const DataFlashContents contents = scan_dataflash(log);
  LogSummary summary;
  static_cast<DataFlashTotals&>(summary) = contents;
  Clock clock;
  FlyingByEvents events;
  std::map<const DataFlashFormat*, FieldsInUse> fields_of;
  for_each_message(log, [&](const DataFlashFormat& format, const std::byte* message) {
    const auto [entry, is_new] = fields_of.try_emplace(&format);
    FieldsInUse& fields = entry->second;
    if (is_new) {
      fields = {time_of(format), format.name == "EV" ? format.find_number("Id") : nullptr};
    }
    if (fields.time) {
      clock.take(format.name,
                 field_value(message, fields.time->field) / fields.time->counts_per_second);
    }
    if (fields.event != nullptr && clock.first) {
      events.take(field_value(message, *fields.event), clock.now(), *clock.first);
    }
    if (summary.firmware.empty()) summary.firmware = message_words(format, message);
  });
  clock.finish();

  summary.types = message_table(contents, clock);
  summary.first_time = clock.first;
  summary.last_time = clock.last;
  summary.gaps = std::move(clock.gaps);
  summary.gap_count = clock.gap_count;
  summary.implausible_times = clock.disbelieved;
  if (clock.last) summary.flying = events.finish(*clock.last);
  if (!summary.flying) summary.flying = flying_by_speed(log);
  return summary;
}

}  // namespace tethercalc
