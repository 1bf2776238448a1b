// The messages of an autopilot's log, whatever its kind: types with named fields, read out of the
// log's own bytes.
//
// A log describes itself: it says of every type of message which fields it has, how each is stored
// and where. That is what is kept here, so that no list of known messages is needed to read one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tethercalc {

/// One field of a message.
struct LogField {
  std::string name;  ///< as in the log; members of arrays and of nested types as `a[2].b`
  /// What it holds:
  ///   b B h H i I q Q   signed and unsigned integers of 1, 2, 4, 8 bytes
  ///   g f d             floating point of 2, 4, 8 bytes
  ///   c C e E           h H i I holding hundredths        L   i holding degrees times 1e7
  ///   M                 flight mode, one byte             a   32 times h
  ///   n N Z             text of up to 4, 16, 64 characters
  ///   t                 text of up to `size` characters
  ///   T                 text up to the end of the message (PX4, whose messages begin with their
  ///                     length)
  /// Letters but the last two are ArduPilot's (libraries/AP_Logger/LogStructure.h).
  char kind = 0;
  std::size_t offset = 0;  ///< bytes from the start of the message, its header included
  std::size_t size = 0;    ///< bytes; 0 for `T`
  std::string unit{};      ///< where the log tells it, such as "m/s" or "deg"; else empty

  /// Whether the field is one number: everything but text and `a`.
  [[nodiscard]] bool is_number() const;
};

/// A type of messages, as the log defines it.
struct LogMessageType {
  std::string name;              ///< such as "XKF1" or "vehicle_attitude"
  std::vector<LogField> fields;  ///< those with a name and of a kind known here
  /// Which of several sensors or estimators wrote its messages, where the type says so (PX4, from
  /// 0).
  std::optional<int> instance{};
  /// The field that says so in each message (ArduPilot: the core of an EKF, the number of a
  /// battery); at most one of the two is there.
  std::optional<std::string> instance_field{};

  /// The field of that name, or nullptr.
  [[nodiscard]] const LogField* find(std::string_view field_name) const;
  /// The same, or nullptr where it is no number.
  [[nodiscard]] const LogField* find_number(std::string_view field_name) const;
};

/// The number in a field, in the unit that its kind implies: hundredths and 1e-7 degrees are
/// divided out (divided, because 5.61 is the double nearest to 561/100 but not to 561·0.01).
/// Integers above 2^53 lose digits; field_text() does not. `message` points at the message's first
/// byte and has as many bytes as its type says. The field must be a number.
[[nodiscard]] double field_value(const std::byte* message, const LogField& field);

/// Any field as text: integers exactly, floating point with the fewest digits that give it back,
/// text up to its first zero byte, the numbers of `a` separated by blanks.
[[nodiscard]] std::string field_text(const std::byte* message, const LogField& field);

/// The time of a message since the controller started: microseconds in a first field `TimeUS` or a
/// field `timestamp`, milliseconds in a first field `TimeMS`. ArduPilot's GPS messages of the older
/// kind count `TimeMS` in the satellites' week and have the controller's in `T`.
struct LogTime {
  LogField field;                ///< which field holds the time
  double counts_per_second = 1;  ///< divide by it
};
/// The field that tells the time of such messages; nothing where none does.
[[nodiscard]] std::optional<LogTime> time_of(const LogMessageType& type);

/// A stretch of bytes in which no message could be read.
struct SkippedBytes {
  std::size_t offset = 0;  ///< of its first byte in the log
  std::size_t bytes = 0;   ///< number of bytes
  /// Messages lost in it, at least: in DataFlash how many marks of a message's beginning it holds,
  /// or one if it holds none; zero for filler behind the last message.
  std::size_t messages = 0;
};

/// How much of a log could be read, and what of it could not.
struct LogTotals {
  std::size_t bytes = 0;              ///< size of the log
  std::size_t messages = 0;           ///< all those read, each of them whole
  std::size_t skipped_bytes = 0;      ///< bytes that belong to no message
  std::size_t skipped_messages = 0;   ///< at least; see SkippedBytes
  std::vector<SkippedBytes> skipped;  ///< the first 100 stretches
  /// Sentences about definitions that could not be used: damaged, or contradicting an earlier one.
  /// Messages of such a type are skipped. At most 100.
  std::vector<std::string> rejected_definitions;

  /// Counts one more stretch, and keeps it if it is among the first 100.
  void add(const SkippedBytes& lost);
  /// Keeps a sentence about a definition, if it is among the first 100.
  void add_rejected(std::string sentence);
};

}  // namespace tethercalc
