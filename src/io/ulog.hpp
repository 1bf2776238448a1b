// PX4 ULog (`.ulg`): what PX4 and what uses its logger writes.
//
// A file is a header of 16 bytes (seven of them fixed, a version, the time in µs) and a sequence of
// messages: length of what follows in 2 bytes, a letter for its kind, content. F messages define
// formats by text, which may contain one another; A messages give a format and an instance a
// number; D messages hold data under that number. So a log describes itself. B tells where data was
// appended after a crash, I, M and P hold information and parameters, L and C the words of the
// firmware, O how long it could not write, S marks a place for readers that lost theirs.
// (docs.px4.io, "ULog File Format".)
//
// The format has no checksum and no mark at a message's beginning. A message counts only if it is
// whole, its content is what its letter promises (data as long as its format, formats and keys that
// can be read, words that are text) and what follows it is such a message, too, or the log's end.
// Where that fails, reading goes on at the next place where two such messages succeed each other.
// Flipped bits inside data, or a number flipped to that of a format of the same length, cannot be
// noticed.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// Whether the content begins as a ULog does; two of the seven fixed bytes may be damaged.
[[nodiscard]] bool looks_like_ulog(std::span<const std::byte> content);

/// Whether the log says that it cannot be read without knowing something this reader does not.
[[nodiscard]] bool needs_newer_ulog_reader(std::span<const std::byte> log);

/// Reads the whole log once. Any bytes are a log, if only one without messages.
[[nodiscard]] LogContents scan_ulog(std::span<const std::byte> log);

/// Every message, whatever its letter, with that letter, its first byte and its whole length.
void for_each_raw_ulog_message(
    std::span<const std::byte> log,
    const std::function<void(char letter, const std::byte* message, std::size_t length)>& visit);

/// As AutopilotLog::for_each: messages with data, and the firmware's words as messages `logging`
/// and `logging_tagged` with the fields `timestamp`, `level` (as syslog counts, 0 emergency to 7
/// debug), `tag` and `message`.
void for_each_ulog_message(
    std::span<const std::byte> log,
    const std::function<void(const LogMessageType& type, const std::byte* message)>& visit);

/// As AutopilotLog::columns.
[[nodiscard]] std::vector<std::vector<double>> extract_ulog_columns(
    std::span<const std::byte> log, std::string_view message, std::span<const std::string> fields,
    std::optional<int> instance);

}  // namespace tethercalc
