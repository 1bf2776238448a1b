#include "io/dataflash_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "io/dataflash_walk.hpp"
#include "io/decimal_number.hpp"
#include "io/letters.hpp"

namespace tethercalc {
namespace {

using dataflash::fmt_type;

/// The part before the next comma, which is taken off `rest` with it.
std::string_view next_value(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view value = rest.substr(0, comma);
  rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  return trimmed(value);
}

template <class T>
std::optional<T> number_in(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = read_number(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// How a text's value of that kind is kept.
char kept_as(char kind) {
  if (std::string_view("cCeELfdg").find(kind) != std::string_view::npos) return 'd';
  if (kind == 'M') return 'N';  // by name
  if (kind == 'a') return 'Z';
  return kind;
}

struct Definition {
  std::uint8_t type = 0;
  std::string kinds;  // as kept
};

class Transcriber {
 public:
  /// False where the line is no message.
  bool take(std::string_view line) {
    const std::string_view name = next_value(line);
    if (name == "FMT") return define(line);
    const auto found = definitions_.find(name);
    if (found == definitions_.end()) return false;
    const std::size_t before = messages_.size();
    begin(found->second.type);
    const std::string& kinds = found->second.kinds;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const bool is_last = i + 1 == kinds.size();
      const bool is_text = std::string_view("nNZ").find(kinds[i]) != std::string_view::npos;
      const bool is_there = i == 0 || was_followed_;
      // Words may hold commas.
      const std::string_view value = is_last && is_text ? trimmed(line) : value_from(line);
      if (!is_there || !put(kinds[i], value)) return undo(before);
    }
    return was_followed_ && !kinds.empty() && !ends_in_text(kinds) ? undo(before) : true;
  }

  std::vector<std::byte> take_messages() { return std::move(messages_); }
  std::vector<std::string> take_rejected() { return std::move(rejected_); }

 private:
  static bool ends_in_text(const std::string& kinds) {
    return std::string_view("nNZ").find(kinds.back()) != std::string_view::npos;
  }

  std::string_view value_from(std::string_view& rest) {
    was_followed_ = rest.find(',') != std::string_view::npos;
    return next_value(rest);
  }

  bool define(std::string_view line) {
    const auto type = number_in<std::uint8_t>(next_value(line));
    const auto length = number_in<std::uint8_t>(next_value(line));
    const std::string_view name = next_value(line);
    const std::string_view format = next_value(line);
    std::string labels;
    while (!line.empty()) {
      if (!labels.empty()) labels += ',';
      labels += next_value(line);
    }
    if (!type || !length || name.empty() || name.size() > dataflash::name_size ||
        format.size() > dataflash::format_size || labels.size() > dataflash::labels_size) {
      return false;
    }
    if (*type == fmt_type) {
      const std::byte* const fmt = dataflash::built_in_fmt.data();
      messages_.insert(messages_.end(), fmt, fmt + dataflash::fmt_length);
      return true;
    }
    Definition definition{*type, {}};
    std::size_t size = dataflash::header_size;
    for (const char kind : format) {
      definition.kinds += kept_as(kind);
      size += dataflash::size_of_kind(kept_as(kind));
      if (dataflash::size_of_kind(kind) == 0) return reject(name, "it has fields of unknown kind");
    }
    constexpr std::size_t longest = 255;  // a DataFlash message
    if (size > longest) return reject(name, "its fields are too long");
    begin(fmt_type);
    put_integer(*type);
    put_integer(static_cast<std::uint8_t>(size));
    put_text(name, dataflash::name_size);
    put_text(definition.kinds, dataflash::format_size);
    put_text(labels, dataflash::labels_size);
    definitions_[std::string(name)] = std::move(definition);
    return true;
  }

  bool reject(std::string_view name, std::string_view reason) {
    rejected_.push_back(
        fmt::format("the definition of message {} cannot be used: {}", name, reason));
    return false;
  }

  bool undo(std::size_t size) {
    messages_.resize(size);
    return false;
  }

  void begin(std::uint8_t type) {
    messages_.insert(messages_.end(),
                     {dataflash::mark_first, dataflash::mark_second, std::byte{type}});
  }

  template <class T>
  void put_integer(T value) {
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    messages_.insert(messages_.end(), bytes.begin(), bytes.end());
  }
  template <class T>
  bool put_number(std::string_view text) {
    const auto value = number_in<T>(text);
    if (value) put_integer(*value);
    return value.has_value();
  }
  bool put_text(std::string_view text, std::size_t size) {
    if (text.size() > size) return false;
    const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
    messages_.insert(messages_.end(), bytes, bytes + text.size());
    messages_.resize(messages_.size() + size - text.size());
    return true;
  }

  bool put(char kind, std::string_view text) {
    switch (kind) {
      case 'b':
        return put_number<std::int8_t>(text);
      case 'B':
        return put_number<std::uint8_t>(text);
      case 'h':
        return put_number<std::int16_t>(text);
      case 'H':
        return put_number<std::uint16_t>(text);
      case 'i':
        return put_number<std::int32_t>(text);
      case 'I':
        return put_number<std::uint32_t>(text);
      case 'q':
        return put_number<std::int64_t>(text);
      case 'Q':
        return put_number<std::uint64_t>(text);
      case 'd':
        return put_number<double>(text);
      default:
        return put_text(text, dataflash::size_of_kind(kind));
    }
  }

  std::vector<std::byte> messages_;
  std::vector<std::string> rejected_;
  std::map<std::string, Definition, std::less<>> definitions_;
  bool was_followed_ = false;  // the value read last, by another one
};

}  // namespace

DataFlashTranscript transcribe_dataflash(std::span<const std::byte> text) {
  const std::string_view all(reinterpret_cast<const char*>(text.data()), text.size());
  Transcriber transcriber;
  DataFlashTranscript transcript;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = all.find('\n', at);
    const bool has_end = end != std::string_view::npos;
    const std::size_t next = has_end ? end + 1 : all.size();
    const std::string_view line = all.substr(at, next - at - (has_end ? 1 : 0));
    const bool is_read = has_end && transcriber.take(line);
    if (!is_read && !trimmed(line).empty()) transcript.skipped.push_back({at, next - at, 1});
    at = next;
  }
  transcript.messages = transcriber.take_messages();
  transcript.rejected = transcriber.take_rejected();
  return transcript;
}

}  // namespace tethercalc
