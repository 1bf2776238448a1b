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

#include "tethercalc/io/dataflash.hpp"

namespace tethercalc::dataflash {

inline constexpr std::byte mark_first{0xA3};
inline constexpr std::byte mark_second{0x95};
inline constexpr std::size_t header_size = 3;
inline constexpr std::uint8_t fmt_type = 128;
inline constexpr std::size_t fmt_length = 89;

static_assert(std::endian::native == std::endian::little,
              "numbers are copied out of the log, which is little-endian");

/// The number that the log holds at `at`.
template <class T>
T read(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// The text at `at`, which ends with the first zero byte or with `size` characters.
inline std::string_view text_at(const std::byte* at, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(at), size);
  return all.substr(0, all.find('\0'));
}

/// Builds the format that the FMT message starting at `message` defines.
DataFlashFormat parse_format(const std::byte* message);

/// The lengths and definitions in force at a point of the log, by type number.
class Definitions {
 public:
  Definitions();

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
  Change take(const std::byte* message);

 private:
  [[nodiscard]] std::optional<std::uint8_t> settled_type_called(std::uint32_t name) const;
  void forget(std::uint8_t type);

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
  explicit Framing(std::span<const std::byte> log);

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
  [[nodiscard]] std::size_t next_message(std::size_t at, const Definitions& known) const;

  /// What was lost between two positions.
  [[nodiscard]] SkippedBytes skipped(std::size_t from, std::size_t to) const;

 private:
  [[nodiscard]] bool mark_at(std::size_t at) const {
    return log_[at] == mark_first && log_[at + 1] == mark_second;
  }
  /// First place from `from` on that holds the first byte of a mark; `end` where none does.
  [[nodiscard]] std::size_t next_mark(std::size_t from, std::size_t end) const;
  [[nodiscard]] bool has_messages_within(std::size_t at, std::size_t length,
                                         const Definitions& known, const TimeGuard& guard) const;
  /// Whether the message that begins at `message` may end before `at`, though no mark is there.
  [[nodiscard]] bool is_followed(std::size_t message, std::size_t at,
                                 const Definitions& known) const;

  std::span<const std::byte> log_;
  std::size_t filler_;  // from here to the end, all bytes are the same filler
};

/// The FMT message that defines FMT itself: what a reader knows before it has read anything.
const std::byte* definition_of_fmt();

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
  visitor.on_format(fmt_type, definition_of_fmt());
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
  visitor.on_format(fmt_type, definition_of_fmt());
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

/// Number of bytes of a field of that kind, 0 where the kind is not known.
std::size_t size_of_kind(char kind);

}  // namespace tethercalc::dataflash
