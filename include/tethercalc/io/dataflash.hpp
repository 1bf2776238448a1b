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

#include "tethercalc/io/log_messages.hpp"

namespace tethercalc {

/// A message type, as an FMT message defines it. Its fields end before one of a kind that this
/// reader does not know. The field that tells several sensors apart is known by its name: `C` (the
/// core of an EKF), `I`, `IMU`, `Inst` or `Instance`, of one byte.
struct DataFlashFormat : LogMessageType {
  std::uint8_t type = 0;   ///< number that marks its messages
  std::size_t length = 0;  ///< bytes of a message, header included
  std::string format;      ///< the kinds of its fields, one character each
  std::string labels;      ///< their names, separated by commas
};

/// The words of a MSG message, in which the firmware says what it is and does; empty for others.
[[nodiscard]] std::string message_words(const LogMessageType& type, const std::byte* message);

/// What a log holds.
struct DataFlashContents : LogTotals {
  /// Messages of one definition.
  struct Type {
    DataFlashFormat format;  ///< its definition
    std::size_t count = 0;   ///< messages read
  };
  /// A message in which the log says something of itself.
  struct Description {
    std::size_t type = 0;                ///< index into `types`
    const std::byte* message = nullptr;  ///< its first byte
  };
  std::vector<Type> types;  ///< in the order of their first definition; some may have no messages
  std::vector<Description> descriptions;  ///< those called MSG, PARM, UNIT and FMTU, in order

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
