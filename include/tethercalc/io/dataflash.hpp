// ArduPilot DataFlash logs: what a flight controller writes to its memory card (`.bin`).
//
// A log is a sequence of messages, each of them the bytes A3 95, a type number and a payload. FMT
// messages define the others: type number, length, name, and the kind and label of every field. So
// a log describes itself, and no list of known messages is needed to read one. (Format: ArduPilot,
// libraries/AP_Logger/LogStructure.h and README.md.)
//
// Logs arrive damaged: cut where the battery was pulled, with blocks missing or filled with zeros.
// Reading goes on behind the damage, and tells how much was skipped. A message counts only if it is
// complete, of a type defined before it, followed by the next message's mark or by the end of the
// data, no disguise for whole messages inside it, and of a time that fits its neighbours'. So one
// that lost or gained bytes, or whose own definition is damaged, is skipped rather than misread.
// Flipped bits inside a payload, or a type number flipped to that of a message of the same length,
// cannot be noticed: the format has no checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tethercalc {

/// One field of a message.
struct DataFlashField {
  std::string name;  ///< as in the definition
  /// What it holds, as in the log's own format string:
  ///   b B h H i I q Q   signed and unsigned integers of 1, 2, 4, 8 bytes
  ///   g f d             floating point of 2, 4, 8 bytes
  ///   c C e E           h H i I holding hundredths        L   i holding degrees times 1e7
  ///   M                 flight mode, one byte             a   32 times h
  ///   n N Z             text of up to 4, 16, 64 characters
  char kind = 0;
  std::size_t offset = 0;  ///< bytes from the start of the message, its 3 bytes of header included

  /// Whether the field is one number: everything but text and `a`.
  [[nodiscard]] bool is_number() const;
};

/// A message type, as an FMT message defines it.
struct DataFlashFormat {
  std::uint8_t type = 0;   ///< number that marks its messages
  std::size_t length = 0;  ///< bytes of a message, header included
  std::string name;        ///< such as "XKF1"
  std::string format;      ///< the kinds of its fields, one character each
  std::string labels;      ///< their names, separated by commas
  /// Fields that have a name; ends before a kind of field that this reader does not know.
  std::vector<DataFlashField> fields;

  /// The field of that name, or nullptr.
  [[nodiscard]] const DataFlashField* find(std::string_view field_name) const;
  /// The same, or nullptr where it is no number.
  [[nodiscard]] const DataFlashField* find_number(std::string_view field_name) const;
};

/// The number in a field, in the unit that the format implies: hundredths and 1e-7 degrees are
/// divided out (divided, because 5.61 is the double nearest to 561/100 but not to 561·0.01).
/// Integers above 2^53 lose digits; field_text() does not. `message` points at the message's first
/// byte and has as many bytes as its format says. The field must be a number.
[[nodiscard]] double field_value(const std::byte* message, const DataFlashField& field);

/// Any field as text: integers exactly, floating point with the fewest digits that give it back,
/// text up to its first zero byte, the numbers of `a` separated by blanks.
[[nodiscard]] std::string field_text(const std::byte* message, const DataFlashField& field);

/// The words of a MSG message, in which the firmware says what it is and does; empty for others.
[[nodiscard]] std::string message_words(const DataFlashFormat& format, const std::byte* message);

/// The time of a message, read from its first field: microseconds in `TimeUS`, milliseconds in
/// `TimeMS`, both since the controller started. GPS messages of the older kind count `TimeMS` in
/// the satellites' week and have the controller's in `T`. Nothing where a message has no time.
struct DataFlashTime {
  DataFlashField field;          ///< which field holds the time
  double counts_per_second = 1;  ///< divide by it
};
/// The field that tells the time of such messages; nothing where none does.
[[nodiscard]] std::optional<DataFlashTime> time_of(const DataFlashFormat& format);

/// A stretch of bytes in which no message could be read.
struct SkippedBytes {
  std::size_t offset = 0;  ///< of its first byte in the log
  std::size_t bytes = 0;   ///< number of bytes
  /// Messages lost in it, at least: how many marks of a message's beginning it holds, or one if it
  /// holds none; zero for filler behind the last message.
  std::size_t messages = 0;
};

/// How much of a log could be read, and what of it could not.
struct DataFlashTotals {
  std::size_t bytes = 0;              ///< size of the log
  std::size_t messages = 0;           ///< all those read, each of them whole
  std::size_t skipped_bytes = 0;      ///< bytes that belong to no message
  std::size_t skipped_messages = 0;   ///< at least; see SkippedBytes
  std::vector<SkippedBytes> skipped;  ///< the first 100 stretches
  /// Sentences about definitions that could not be used: damaged, or contradicting an earlier one.
  /// Messages of such a type are skipped. At most 100.
  std::vector<std::string> rejected_definitions;
};

/// Throws InputError where there is no message at all in what `name` names.
void require_messages(const DataFlashTotals& totals, const std::string& name);

/// What a log holds.
struct DataFlashContents : DataFlashTotals {
  /// Messages of one definition.
  struct Type {
    DataFlashFormat format;  ///< its definition
    std::size_t count = 0;   ///< messages read
  };
  std::vector<Type> types;  ///< in the order of their first definition; some may have no messages

  /// Number of messages of that name, of all types that bear it.
  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// The format of the messages of that name; nullptr where the log defines none. Where several
  /// types bear the name, the one with the most messages.
  [[nodiscard]] const DataFlashFormat* find(std::string_view name) const;
};

/// Reads the whole log once. Any bytes are a log, if only one without messages; nothing is thrown.
[[nodiscard]] DataFlashContents scan_dataflash(std::span<const std::byte> log);

/// Calls `visit` for each message in the log's order, with its format and its first byte. Formats
/// stay where they are until the function returns, so that their address can be a key.
void for_each_message(
    std::span<const std::byte> log,
    const std::function<void(const DataFlashFormat& format, const std::byte* message)>& visit);

/// Which messages of a name are wanted, where several sensors or estimators write the same: those
/// whose `field` holds `value`, such as {"C", 0} for the first EKF core.
struct DataFlashInstance {
  std::string field;  ///< name of the distinguishing field
  double value = 0;   ///< its wanted value
};

/// The values of `fields`, in the order asked for, from all messages called `name` (or those of one
/// instance) that have them all; one vector a field, all of equal length, holding no more memory
/// than its values. Empty vectors where there is no such message. Fields must be numbers; a message
/// type in which one of them is not counts as one that lacks it.
[[nodiscard]] std::vector<std::vector<double>> extract_columns(
    std::span<const std::byte> log, std::string_view name, std::span<const std::string> fields,
    const std::optional<DataFlashInstance>& instance = std::nullopt);

}  // namespace tethercalc
