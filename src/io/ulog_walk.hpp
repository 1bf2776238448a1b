// The one loop over a ULog that every use of one runs through.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/log_bytes.hpp"
#include "tethercalc/io/log_messages.hpp"

namespace tethercalc::ulog {

inline constexpr std::size_t file_header_size = 16;
inline constexpr std::size_t header_size = 3;
inline constexpr std::size_t data_at = header_size + 2;  // behind the number of its format
inline constexpr std::size_t flags_size = 40;
inline constexpr std::array<std::uint8_t, 8> sync_magic = {0x2F, 0x73, 0x13, 0x20,
                                                           0x25, 0x0C, 0xBB, 0x12};

inline std::uint8_t byte_at(const std::byte* at) { return std::to_integer<std::uint8_t>(*at); }
inline char letter_of(const std::byte* message) { return static_cast<char>(byte_at(message + 2)); }
inline std::size_t length_of(const std::byte* message) {
  return header_size + log_bytes::read<std::uint16_t>(message);
}
/// The content of a message from `offset` on, as characters.
inline std::string_view text_from(const std::byte* message, std::size_t offset) {
  return {reinterpret_cast<const char*>(message + offset), length_of(message) - offset};
}

/// Whether the message shows too little to be told from chance: topic 2 at a time whose lowest byte
/// is 4F reads as a message O, "02 00 4F".
inline bool is_doubtful(const std::byte* message) {
  return letter_of(message) == 'O' || letter_of(message) == 'R';
}
/// A type as a format writes it: "float", "uint8_t[4]", "esc_report[8]".
struct TypeText {
  std::string_view name;
  std::size_t count = 1;
  bool is_array = false;
};
/// Nothing where it cannot be read.
std::optional<TypeText> type_text(std::string_view text);
/// Bytes of a basic type; 0 where the name is none.
std::size_t size_of_basic(std::string_view type);

/// The key and value in an I, M, P or Q message.
struct KeyAndValue {
  TypeText type;
  std::string_view key;
  const std::byte* value = nullptr;
  std::size_t size = 0;  ///< bytes of the value
};
/// What a message says whose key's length is at `offset`; nothing where that cannot be right.
std::optional<KeyAndValue> key_and_value(const std::byte* message, std::size_t offset);

/// The formats and numbers in force at a point of the log.
class Definitions {
 public:
  enum class Outcome { unchanged, defined, rejected };
  struct Change {
    Outcome outcome = Outcome::unchanged;
    std::string sentence = {};  ///< why it was rejected
  };

  /// Takes over what an F message says.
  Change take_format(const std::byte* message);
  /// Takes over what an A message says.
  Change take_subscription(const std::byte* message);
  /// Takes over what an R message says.
  void take_removal(const std::byte* message);

  /// Whether an F message's text can be right.
  [[nodiscard]] static bool is_format(const std::byte* message);
  /// Whether the format that an A message names is defined.
  [[nodiscard]] bool knows_format(std::string_view name) const {
    return formats_.find(name) != formats_.end();
  }
  [[nodiscard]] bool is_subscribed(std::size_t number) const {
    return number < data_.size() && data_[number].most > 0;
  }
  /// Whether data of that number can have that many bytes (padding at its end is left out or not).
  [[nodiscard]] bool has_size(std::size_t number, std::size_t bytes) const {
    return number < data_.size() && bytes >= data_[number].least && bytes <= data_[number].most;
  }
  /// What the number stands for; nullptr where nothing does. Stays where it is.
  [[nodiscard]] const LogMessageType* type(std::size_t number) const {
    return number < data_.size() ? data_[number].type : nullptr;
  }

 private:
  struct Layout {
    std::vector<LogField> fields;
    std::size_t size = 0;    // bytes
    std::size_t needed = 0;  // bytes without the padding at the end
  };
  /// Appends the fields of a format to `layout`. False where one cannot be resolved.
  bool lay_out(std::string_view format, const std::string& prefix, Layout& layout,
               std::size_t depth) const;
  void forget(std::size_t number);

  struct Data {
    std::size_t least = 1;  // bytes of its data; least > most where it is not in force
    std::size_t most = 0;
    const LogMessageType* type = nullptr;
    bool contradicted = false;
  };
  std::map<std::string, std::string, std::less<>> formats_;  // fields by name
  std::vector<Data> data_;
  std::deque<LogMessageType> types_;  // also those no longer in force
};

/// Where in the log messages can be, and where a section of it ends.
class Framing {
 public:
  Framing(std::span<const std::byte> log, std::size_t end) : log_(log.first(end)) {}

  /// Length of the message at `at` if it is whole and its content what its letter promises; else 0.
  [[nodiscard]] std::size_t credible_at(std::size_t at, const Definitions& known) const;

  /// Whether what stands at `at` may follow a message: nothing more, a credible message, one that
  /// the log's end cuts, or messages that are damaged or of a lost definition up to such a one.
  [[nodiscard]] bool may_follow(std::size_t at, const Definitions& known) const;

  /// First position from `at` on where a credible message is followed by what may follow one; the
  /// end of the section where there is none.
  [[nodiscard]] std::size_t next_message(std::size_t at, const Definitions& known) const;

 private:
  [[nodiscard]] bool is_credible(const std::byte* message, std::size_t length,
                                 const Definitions& known) const;
  /// Length of what is data by all but its letter, or by all but its number's definition; else 0.
  [[nodiscard]] std::size_t damaged_at(std::size_t at, const Definitions& known) const;
  /// Whether a message begins at `at` that goes on behind the end.
  [[nodiscard]] bool is_cut(std::size_t at, const Definitions& known) const;

  std::span<const std::byte> log_;
};

/// Where the sections of the log end: at data appended after a crash, and at its end.
std::vector<std::size_t> section_ends(std::span<const std::byte> log);

/// Walks through the log and tells the visitor
///   on_message(letter, message, length, Definitions&)   after it was taken over;
///   on_rejected(std::string sentence)                    a definition that could not be used;
///   on_skipped(SkippedBytes).
template <class Visitor>
void walk(std::span<const std::byte> log, Visitor& visitor) {
  Definitions known;
  std::size_t at = std::min(log.size(), file_header_size);
  const auto take = [&](char letter, const std::byte* message) {
    Definitions::Change change;
    if (letter == 'F') change = known.take_format(message);
    if (letter == 'A') change = known.take_subscription(message);
    if (letter == 'R') known.take_removal(message);
    if (change.outcome == Definitions::Outcome::rejected) {
      visitor.on_rejected(std::move(change.sentence));
    }
  };
  for (const std::size_t end : section_ends(log)) {
    const Framing framing(log, end);
    // What stands at `at` was found credible as the follower of the message before.
    std::size_t length = 0;
    while (at < end) {
      if (length == 0) length = framing.credible_at(at, known);
      const std::byte* const message = log.data() + at;
      std::size_t next_length = 0;
      bool believed = length > 0;
      if (believed) {
        next_length = framing.credible_at(at + length, known);
        // A definition makes what follows it credible.
        const bool defines = letter_of(message) == 'A' || letter_of(message) == 'F';
        const bool is_sure = next_length != 0 && !is_doubtful(message + length);
        if (!is_sure && !framing.may_follow(at + length, known)) {
          believed = defines;
          if (defines) {
            Definitions with = known;
            if (letter_of(message) == 'F') (void)with.take_format(message);
            if (letter_of(message) == 'A') (void)with.take_subscription(message);
            believed = framing.may_follow(at + length, with);
          }
        }
      }
      if (!believed) {
        const std::size_t next = framing.next_message(at + 1, known);
        visitor.on_skipped(SkippedBytes{at, next - at, 1});
        at = next;
        length = 0;
        continue;
      }
      take(letter_of(message), message);
      visitor.on_message(letter_of(message), message, length, known);
      at += length;
      length = next_length;
      // Numbers may have lost their meaning.
      if (letter_of(message) == 'R' || letter_of(message) == 'A' || letter_of(message) == 'F') {
        length = 0;
      }
    }
  }
}

}  // namespace tethercalc::ulog
