// The one loop over a DataFlash log that every use of a log runs through.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "io/log_bytes.hpp"
#include "tethercalc/io/dataflash.hpp"

namespace tethercalc::dataflash {

using log_bytes::read;
using log_bytes::text_at;

inline constexpr std::byte mark_first{0xA3};
inline constexpr std::byte mark_second{0x95};
inline constexpr std::size_t header_size = 3;
inline constexpr std::uint8_t fmt_type = 128;
inline constexpr std::size_t fmt_length = 89;

// Layout of an FMT message behind its header: B type, B length, n name, N format, Z labels.
inline constexpr std::size_t type_at = header_size;
inline constexpr std::size_t length_at = type_at + 1;
inline constexpr std::size_t name_at = length_at + 1;
inline constexpr std::size_t name_size = 4;
inline constexpr std::size_t format_at = name_at + name_size;
inline constexpr std::size_t format_size = 16;
inline constexpr std::size_t labels_at = format_at + format_size;
inline constexpr std::size_t labels_size = 64;
static_assert(labels_at + labels_size == fmt_length);

inline std::string_view name_in(const std::byte* fmt) { return text_at(fmt + name_at, name_size); }
inline std::string_view format_in(const std::byte* fmt) {
  return text_at(fmt + format_at, format_size);
}
inline std::string_view labels_in(const std::byte* fmt) {
  return text_at(fmt + labels_at, labels_size);
}

/// The name as one number, to compare it with many.
inline std::uint32_t name_number(const std::byte* fmt) {
  const std::string_view name = name_in(fmt);
  std::uint32_t number = 0;
  std::memcpy(&number, name.data(), name.size());
  return number;
}

inline bool same_definition(const std::byte* a, const std::byte* b) {
  return a[length_at] == b[length_at] && name_in(a) == name_in(b) && format_in(a) == format_in(b) &&
         labels_in(a) == labels_in(b);
}

/// Whether the first field is of that kind and has that name.
inline bool begins_with(const std::byte* fmt, char kind, std::string_view label) {
  const std::string_view labels = labels_in(fmt);
  return format_in(fmt).starts_with(kind) && labels.substr(0, labels.find(',')) == label;
}

inline bool is_name_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

/// Number of bytes of a field of that kind, 0 where the kind is not known.
inline std::size_t size_of_kind(char kind) {
  static constexpr std::pair<std::string_view, std::size_t> all[] = {
      {"bBM", 1}, {"hHcCg", 2}, {"iIfLeEn", 4}, {"qQd", 8}, {"N", 16}, {"aZ", 64}};
  for (const auto& [kinds, bytes] : all) {
    if (kinds.find(kind) != std::string_view::npos) return bytes;
  }
  return 0;
}

/// Why a definition cannot be right, or an empty text. The length is given twice, once as a number
/// and once by the fields; where the two disagree, one of them is damaged. (A format without any
/// fields, or with a kind not known here, leaves only the number.)
inline std::string_view fault_in(const std::byte* fmt) {
  const std::string_view name = name_in(fmt);
  if (name.empty() || !std::ranges::all_of(name, is_name_character)) {
    return "its name is not made of letters and digits";
  }
  const std::string_view labels = labels_in(fmt);
  if (!std::ranges::all_of(labels, [](char c) { return c > 0x20 && c < 0x7F; })) {
    return "its fields' names are not plain text";
  }
  std::size_t length = header_size;
  for (const char kind : format_in(fmt)) {
    const std::size_t size = size_of_kind(kind);
    if (size == 0) return std::to_integer<std::size_t>(fmt[length_at]) >= length ? "" : "too short";
    length += size;
  }
  return std::to_integer<std::size_t>(fmt[length_at]) == length
             ? ""
             : "its length is not that of its fields";
}

constexpr std::array<std::byte, fmt_length> make_definition_of_fmt() {
  std::array<std::byte, fmt_length> fmt{};
  const auto put = [&fmt](std::size_t at, std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) fmt[at + i] = static_cast<std::byte>(text[i]);
  };
  fmt[0] = mark_first;
  fmt[1] = mark_second;
  fmt[2] = std::byte{fmt_type};
  fmt[type_at] = std::byte{fmt_type};
  fmt[length_at] = std::byte{fmt_length};
  put(name_at, "FMT");
  put(format_at, "BBnNZ");
  put(labels_at, "Type,Length,Name,Format,Columns");
  return fmt;
}

/// The FMT message that defines FMT itself: what a reader knows before it has read anything.
inline constexpr std::array<std::byte, fmt_length> built_in_fmt = make_definition_of_fmt();

/// Whether a field of that name says which of several sensors or estimators wrote the message, as
/// the unit "#" does in newer logs (ArduPilot, libraries/AP_Logger/LogStructure.h).
inline bool tells_instance(std::string_view label) {
  constexpr std::array<std::string_view, 5> names = {"C", "I", "IMU", "Inst", "Instance"};
  return std::ranges::find(names, label) != names.end();
}

/// Builds the format that the FMT message starting at `message` defines.
inline DataFlashFormat parse_format(const std::byte* message) {
  DataFlashFormat format;
  format.type = std::to_integer<std::uint8_t>(message[type_at]);
  format.length = std::to_integer<std::size_t>(message[length_at]);
  format.name = name_in(message);
  format.format = format_in(message);
  format.labels = labels_in(message);
  std::string_view labels = format.labels;
  std::size_t offset = header_size;
  for (const char kind : format.format) {
    const std::size_t size = size_of_kind(kind);
    if (size == 0 || labels.empty()) break;
    const std::size_t comma = labels.find(',');
    const std::string_view label = labels.substr(0, comma);
    format.fields.push_back({std::string(label), kind, offset, size});
    if (kind == 'B' && tells_instance(label)) format.instance_field = label;
    labels.remove_prefix(comma == std::string_view::npos ? labels.size() : comma + 1);
    offset += size;
  }
  return format;
}

/// The lengths and definitions in force at a point of the log, by type number.
class Definitions {
 public:
  Definitions() {
    length_[fmt_type] = fmt_length;
    definition_[fmt_type] = built_in_fmt.data();
    settled_[fmt_type] = true;
    name_[fmt_type] = name_number(built_in_fmt.data());
  }

  /// Length of a message of `type`, 0 where it is not known.
  [[nodiscard]] std::size_t length(std::byte type) const {
    return length_[std::to_integer<std::size_t>(type)];
  }

  /// The time that the message starting at `message` carries in its first field, in µs; nothing for
  /// a type without one. The type must be known.
  [[nodiscard]] std::optional<std::int64_t> time_us(const std::byte* message) const {
    switch (time_[std::to_integer<std::size_t>(message[2])]) {
      case TimeKind::microseconds: {
        // Differences of times must not overflow; above this, none is plausible anyway.
        constexpr std::uint64_t greatest = std::uint64_t{1} << 62;
        const auto count = read<std::uint64_t>(message + header_size);
        return static_cast<std::int64_t>(std::min(count, greatest));
      }
      case TimeKind::milliseconds:
        return std::int64_t{read<std::uint32_t>(message + header_size)} * 1000;
      case TimeKind::none:
        break;
    }
    return std::nullopt;
  }

  /// A log has begun anew where FMT defined itself.
  enum class Outcome { unchanged, defined, rejected, begun };
  struct Change {
    Outcome outcome = Outcome::unchanged;
    std::uint8_t type = 0;
    std::string_view reason = {};  ///< why it was rejected
  };
  /// Takes over what the FMT message starting at `message` defines.
  Change take(const std::byte* message) {
    const auto type = std::to_integer<std::uint8_t>(message[type_at]);
    if (type == fmt_type) {
      // Every log begins with the definition of FMT itself, so here one may begin behind another,
      // and its numbers may mean other messages.
      if (name_in(message) == "FMT" && format_in(message) == "BBnNZ") {
        settled_.fill(false);
        settled_[fmt_type] = true;
        return {Outcome::begun, type};
      }
      return {Outcome::rejected, type, "that number is FMT's own"};
    }
    if (const std::string_view fault = fault_in(message); !fault.empty()) {
      return {Outcome::rejected, type, fault};
    }
    if (const auto other = settled_type_called(name_number(message)); other && *other != type) {
      forget(*other);
      settled_[type] = true;
      forget(type);
      return {Outcome::rejected, type, "another number was defined with the same name"};
    }
    if (!settled_[type]) {
      settled_[type] = true;
      const std::byte* const before = definition_[type];
      definition_[type] = message;
      name_[type] = name_number(message);
      length_[type] = std::to_integer<std::uint8_t>(message[length_at]);
      time_[type] = begins_with(message, 'Q', "TimeUS")   ? TimeKind::microseconds
                    : begins_with(message, 'I', "TimeMS") ? TimeKind::milliseconds
                                                          : TimeKind::none;
      const bool same = before != nullptr && same_definition(before, message);
      return {same ? Outcome::unchanged : Outcome::defined, type};
    }
    if (definition_[type] != nullptr && same_definition(definition_[type], message)) return {};
    // One of the two is damaged, and nothing tells which.
    forget(type);
    return {Outcome::rejected, type, "it contradicts an earlier definition of the same number"};
  }

 private:
  [[nodiscard]] std::optional<std::uint8_t> settled_type_called(std::uint32_t name) const {
    for (std::size_t type = 0; type < name_.size(); ++type) {
      if (name_[type] == name && settled_[type]) return static_cast<std::uint8_t>(type);
    }
    return std::nullopt;
  }
  void forget(std::uint8_t type) {
    definition_[type] = nullptr;
    length_[type] = 0;
    name_[type] = 0;
  }

  std::array<std::uint8_t, 256> length_{};
  enum class TimeKind : std::uint8_t { none, microseconds, milliseconds };
  std::array<TimeKind, 256> time_{};
  std::array<std::uint32_t, 256> name_{};           // its four characters, 0 where none is in force
  std::array<const std::byte*, 256> definition_{};  // the FMT message in force, nullptr if none
  std::array<bool, 256> settled_{};                 // defined since the log began anew
};

/// Whether a message's time can be right. A message whose type number is lost takes a byte of its
/// payload for one, and where that number's length happens to fit, only its time betrays it: that
/// is shifted by whole bytes, which is a factor of 256.
class TimeGuard {
 public:
  /// Near the log's latest time, or near the latest of the same type (which may have a clock of its
  /// own); anything is plausible before the first time.
  [[nodiscard]] bool is_plausible(std::uint8_t type, std::int64_t time) const {
    return clock_ == none || follows(clock_, time) || follows(own_[type], time);
  }

  /// Takes the next time. Says whether the message is to be believed: if its time is plausible, or
  /// follows one that was not (so that only the first message after a jump is lost).
  bool accept(std::uint8_t type, std::int64_t time) {
    if (clock_ == none || follows(clock_, time) || follows(rejected_, time)) {
      clock_ = time;
      rejected_ = none;
    } else if (!follows(own_[type], time)) {
      rejected_ = time;
      return false;
    }
    own_[type] = time;
    return true;
  }

 private:
  // Messages are written a little out of order, by milliseconds; pauses can be long.
  static constexpr std::int64_t furthest_back = 10'000'000;       // µs
  static constexpr std::int64_t furthest_ahead = 3'600'000'000;   // µs
  static constexpr std::int64_t none = -(std::int64_t{1} << 62);  // no time follows it
  static bool follows(std::int64_t before, std::int64_t time) {
    return time >= before - furthest_back && time <= before + furthest_ahead;
  }

  static constexpr std::array<std::int64_t, 256> all_none() {
    std::array<std::int64_t, 256> times{};
    times.fill(none);
    return times;
  }

  std::int64_t clock_ = none;
  std::int64_t rejected_ = none;
  std::array<std::int64_t, 256> own_ = all_none();
};

/// Whether a mark may begin and end among the `size` bytes at `first`: false only if there is none.
/// Asked of every message, so it looks at eight places at a time. A byte of `differs` is zero where
/// both bytes of a mark match, and a zero byte is what the subtraction borrows from (Mycroft's
/// test; Warren, Hacker's Delight, section 6-1).
inline bool may_have_mark_within(const std::byte* first, std::size_t size) {
  constexpr std::uint64_t ones = 0x0101'0101'0101'0101;
  constexpr std::uint64_t tops = 0x8080'8080'8080'8080;
  constexpr std::size_t places = sizeof(std::uint64_t);
  const auto mark_among = [&](const std::byte* at) {
    const std::uint64_t differs =
        (read<std::uint64_t>(at) ^ (ones * std::to_integer<std::uint64_t>(mark_first))) |
        (read<std::uint64_t>(at + 1) ^ (ones * std::to_integer<std::uint64_t>(mark_second)));
    return (differs - ones) & ~differs & tops;
  };
  if (size < places + 1) return true;  // too short for this: the caller looks closer
  const std::size_t last = size - places - 1;
  std::uint64_t found = mark_among(first + last);
  for (std::size_t from = 0; from < last; from += places) found |= mark_among(first + from);
  return found != 0;
}

/// Where in the log messages can be, and where they end.
class Framing {
 public:
  explicit Framing(std::span<const std::byte> log) : log_(log), filler_(log.size()) {
    // Memory that was never written reads as all zeros or all ones. A run shorter than the longest
    // message is not taken for it: it may be the end of one.
    constexpr std::size_t shortest_run = 256;
    if (log.empty() || (log.back() != std::byte{0x00} && log.back() != std::byte{0xFF})) return;
    std::size_t start = log.size();
    while (start > 0 && log[start - 1] == log.back()) --start;
    if (log.size() - start >= shortest_run) filler_ = start;
  }

  /// Length of the message at `at` if one begins there, is complete, and is followed by what may
  /// follow a message; otherwise 0.
  [[nodiscard]] std::size_t message_at(std::size_t at, const Definitions& known) const {
    if (at + header_size > log_.size() || !mark_at(at)) return 0;
    const std::size_t length = known.length(log_[at + 2]);
    if (length == 0 || length > log_.size() - at) return 0;
    const std::size_t next = at + length;
    const bool followed = next + 1 < log_.size() && mark_at(next);
    return followed || is_followed(at, next, known) ? length : 0;
  }

  /// Whether what seems to be one message of `length` bytes is rather a damaged header in front of
  /// whole messages that end where it ends: with marks all over a log, a wrong length easily leads
  /// to one.
  [[nodiscard]] bool hides_messages(std::size_t at, std::size_t length, const Definitions& known,
                                    const TimeGuard& guard) const {
    return may_have_mark_within(log_.data() + at + header_size, length - header_size) &&
           has_messages_within(at, length, known, guard);
  }

  /// First position from `at` on where message_at() finds a message, or the log's end.
  [[nodiscard]] std::size_t next_message(std::size_t at, const Definitions& known) const {
    at = next_mark(at, log_.size());
    while (at < log_.size() && message_at(at, known) == 0) at = next_mark(at + 1, log_.size());
    return at;
  }

  /// What was lost between two positions.
  [[nodiscard]] SkippedBytes skipped(std::size_t from, std::size_t to) const {
    SkippedBytes lost{from, to - from, 0};
    if (from >= filler_) return lost;
    for (std::size_t i = from; i + 1 < to; ++i) lost.messages += mark_at(i) ? 1 : 0;
    if (lost.messages == 0) lost.messages = 1;
    return lost;
  }

 private:
  [[nodiscard]] bool mark_at(std::size_t at) const {
    return log_[at] == mark_first && log_[at + 1] == mark_second;
  }
  /// First place from `from` on that holds the first byte of a mark; `end` where none does.
  [[nodiscard]] std::size_t next_mark(std::size_t from, std::size_t end) const {
    const void* const found =
        std::memchr(log_.data() + from, std::to_integer<int>(mark_first), end - from);
    if (found == nullptr) return end;
    return static_cast<std::size_t>(static_cast<const std::byte*>(found) - log_.data());
  }
  [[nodiscard]] bool has_messages_within(std::size_t at, std::size_t length,
                                         const Definitions& known, const TimeGuard& guard) const {
    const std::size_t end = at + length;
    const auto leads_to_end = [&](std::size_t from) {
      while (from + header_size <= end && mark_at(from)) {
        const std::size_t step = known.length(log_[from + 2]);
        if (step == 0 || step > end - from) return false;
        const auto time = known.time_us(log_.data() + from);
        if (time && !guard.is_plausible(std::to_integer<std::uint8_t>(log_[from + 2]), *time)) {
          return false;
        }
        from += step;
      }
      return from == end;
    };
    std::size_t from = next_mark(at + header_size, end);
    while (from + header_size <= end && !leads_to_end(from)) from = next_mark(from + 1, end);
    return from + header_size <= end;
  }
  /// Whether the message that begins at `message` may end before `at`, though no mark is there.
  [[nodiscard]] bool is_followed(std::size_t message, std::size_t at,
                                 const Definitions& known) const {
    // Filler must begin right here: if the message seems to end inside it, its own end may be
    // filler.
    if (at == filler_ || at == log_.size()) return true;
    // One damaged byte in the next message's mark must not cost this message, if the one after the
    // next is where it should be and nothing before it looks like a mark: had bytes been lost or
    // gained, the next one's mark would be whole, and elsewhere.
    const std::size_t left = log_.size() - at;
    if (left < header_size || (log_[at] != mark_first && log_[at + 1] != mark_second)) return false;
    const std::size_t length = known.length(log_[at + 2]);
    if (length == 0 || length > left || left - length == 1) return false;
    if (length < left && !mark_at(at + length)) return false;
    const auto begin = log_.begin() + static_cast<std::ptrdiff_t>(message + header_size);
    const auto end = log_.begin() + static_cast<std::ptrdiff_t>(at + length);
    constexpr std::array mark = {mark_first, mark_second};
    return std::search(begin, end, mark.begin(), mark.end()) == end;
  }

  std::span<const std::byte> log_;
  std::size_t filler_;  // from here to the end, all bytes are the same filler
};

/// Tells the visitor of a message, and of what it defines. True where a log begins with it.
template <class Visitor>
bool tell(const std::byte* message, Definitions& known, Visitor& visitor) {
  const auto type = std::to_integer<std::uint8_t>(message[2]);
  bool begun = false;
  if (type == fmt_type) {
    const Definitions::Change change = known.take(message);
    begun = change.outcome == Definitions::Outcome::begun;
    if (change.outcome == Definitions::Outcome::defined) visitor.on_format(change.type, message);
    if (change.outcome == Definitions::Outcome::rejected) {
      visitor.on_rejected(change.type, message, change.reason);
    }
  }
  visitor.on_message(type, message);
  return begun;
}

/// Walks through the log. The visitor is told, beginning with the definition of FMT, in the log's
/// order:
///   on_format(type, const std::byte* fmt)   the FMT message at `fmt` now defines `type`;
///   on_rejected(type, const std::byte* fmt, std::string_view reason)   it could not be used;
///   on_message(type, const std::byte* message)   after the above, if it is an FMT message;
///   on_skipped(SkippedBytes).
template <class Visitor>
void walk(std::span<const std::byte> log, Visitor& visitor) {
  const Framing framing(log);
  Definitions known;
  TimeGuard guard;
  const auto believed_length = [&](std::size_t at) -> std::size_t {
    const std::size_t length = framing.message_at(at, known);
    if (length == 0 || framing.hides_messages(at, length, known, guard)) return 0;
    const auto time = known.time_us(log.data() + at);
    return !time || guard.accept(std::to_integer<std::uint8_t>(log[at + 2]), *time) ? length : 0;
  };
  visitor.on_format(fmt_type, built_in_fmt.data());
  std::size_t at = 0;
  while (at < log.size()) {
    const std::size_t length = believed_length(at);
    if (length == 0) {
      const std::size_t next = framing.next_message(at + 1, known);
      visitor.on_skipped(framing.skipped(at, next));
      at = next;
      continue;
    }
    if (tell(log.data() + at, known, visitor)) guard = TimeGuard();
    at += length;
  }
}

/// Walks through a log whose damage a first walk has told, without looking for it again. The
/// visitor is told all the rest as in walk().
template <class Visitor>
void walk_again(std::span<const std::byte> log, std::span<const SkippedBytes> skipped,
                Visitor& visitor) {
  Definitions known;
  visitor.on_format(fmt_type, built_in_fmt.data());
  std::size_t at = 0;
  while (at < log.size()) {
    if (!skipped.empty() && at == skipped.front().offset) {
      at += skipped.front().bytes;
      skipped = skipped.subspan(1);
      continue;
    }
    const std::size_t length = known.length(log[at + 2]);
    tell(log.data() + at, known, visitor);
    at += length;
  }
}

}  // namespace tethercalc::dataflash
