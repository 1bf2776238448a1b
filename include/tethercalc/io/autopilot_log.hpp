// An autopilot's log of any kind, read in one way: ArduPilot DataFlash, binary (`.bin`) or as text
// (`.log`), and PX4 ULog (`.ulg`).
//
// A log is a sequence of messages of named types (log_messages.hpp); several sensors or estimators
// may write the same type, each an instance. To get at numbers, ask for the columns wanted:
//
//   const AutopilotLog log(bytes, "flight.ulg");
//   const std::vector<std::string> fields = {"voltage_v", "current_a"};
//   const LogSeries battery = log.series("battery_status", fields, 0);
//   // battery.time[i] in s, battery.columns[0][i] in V, battery.columns[1][i] in A
//
// The names are the log's own: ArduPilot's BAT has Volt and Curr (its older CURR likewise), PX4's
// battery_status voltage_v and current_a. `contents()` tells which there are.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/log_messages.hpp"

namespace tethercalc {

/// Kinds of logs, by what writes them and how.
enum class LogFormat {
  dataflash,       ///< ArduPilot, binary: `.bin`
  dataflash_text,  ///< ArduPilot, as a ground station writes it out: `.log`
  ulog,            ///< PX4: `.ulg`
};

/// What a log holds.
struct LogContents : LogTotals {
  static constexpr std::size_t most_words = 1000;  ///< sentences kept of what the firmware said
  /// Messages of one definition and, in ULog, of one instance.
  struct Type {
    LogMessageType type;    ///< its definition; with units where the log tells them
    std::size_t count = 0;  ///< messages read
  };
  /// Messages that the autopilot could not write fast enough (ULog).
  struct Dropout {
    double time = 0;      ///< s, of the last message before it; 0 where there is none
    double duration = 0;  ///< s
  };
  std::vector<Type> types;  ///< in the order of their first definition; some may have no messages
  std::vector<Dropout> dropouts;                   ///< in order
  std::map<std::string, std::string> information;  ///< ULog: what the log says of itself, by key
  std::vector<std::string> words;                  ///< the firmware's, the first `most_words`
  /// As they were at the log's beginning, by name.
  std::map<std::string, double> parameters;

  /// Number of messages of that name, of all types that bear it.
  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// The type of the messages of that name; nullptr where the log defines none. Where several bear
  /// the name, the first of those with the most messages.
  [[nodiscard]] const LogMessageType* find(std::string_view name) const;
};

/// Columns of numbers with their time; all of one length.
struct LogSeries {
  std::vector<double> time;                  ///< s since the controller started
  std::vector<std::vector<double>> columns;  ///< one a field, in the order asked for
};

/// A log, read from bytes that must outlive it.
class AutopilotLog {
 public:
  /// Reads the whole log once; `name` stands for it in messages. Throws InputError where it is none
  /// of the kinds known, telling what it is instead where its content shows that.
  AutopilotLog(std::span<const std::byte> content, std::string name);
  AutopilotLog(const AutopilotLog&) = delete;
  AutopilotLog& operator=(const AutopilotLog&) = delete;

  /// Which kind it is.
  [[nodiscard]] LogFormat format() const { return format_; }
  /// As given to the constructor.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Types, counts and damage.
  [[nodiscard]] const LogContents& contents() const { return contents_; }

  /// Calls `visit` for each message in the log's order, with its type and its first byte, from
  /// which field_value() and field_text() read. Types stay where they are until the function
  /// returns, so that their address can be a key.
  void for_each(
      const std::function<void(const LogMessageType& type, const std::byte* message)>& visit) const;

  /// The instances that wrote messages of that name, rising; empty where the type knows none.
  [[nodiscard]] std::vector<int> instances(std::string_view message) const;

  /// The values of `fields`, in the order asked for, from all messages of that name (or those of
  /// one instance) that have them all; one vector a field, all of equal length. Empty vectors where
  /// there is no such message. Fields must be numbers; a message in which one is not counts as one
  /// that lacks it. Where the messages know no instances, `instance` has no meaning.
  [[nodiscard]] std::vector<std::vector<double>> columns(
      std::string_view message, std::span<const std::string> fields,
      std::optional<int> instance = std::nullopt) const;

  /// The same with their time; empty also where the messages have no time.
  [[nodiscard]] LogSeries series(std::string_view message, std::span<const std::string> fields,
                                 std::optional<int> instance = std::nullopt) const;

 private:
  LogFormat format_ = LogFormat::dataflash;
  std::string name_;
  std::vector<std::byte> transcript_;  // the messages of a text, in binary
  std::span<const std::byte> messages_;
  LogContents contents_;
};

/// Whether the content is a text rather than a binary file: among its first bytes neither control
/// characters but those that lay out text nor the mark of a DataFlash message.
[[nodiscard]] bool looks_like_text(std::span<const std::byte> content);

/// Whether it is a text with the messages of an ArduPilot log.
[[nodiscard]] bool looks_like_dataflash_text(std::span<const std::byte> content);

}  // namespace tethercalc
