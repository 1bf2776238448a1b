#include "io/ulog_walk.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

namespace tethercalc::ulog {
namespace {

struct BasicType {
  std::string_view name;
  std::size_t size;
  char kind;  // as in LogField
};
constexpr std::array<BasicType, 12> basic_types = {{{"int8_t", 1, 'b'},
                                                    {"uint8_t", 1, 'B'},
                                                    {"int16_t", 2, 'h'},
                                                    {"uint16_t", 2, 'H'},
                                                    {"int32_t", 4, 'i'},
                                                    {"uint32_t", 4, 'I'},
                                                    {"int64_t", 8, 'q'},
                                                    {"uint64_t", 8, 'Q'},
                                                    {"float", 4, 'f'},
                                                    {"double", 8, 'd'},
                                                    {"bool", 1, 'b'},
                                                    {"char", 1, 't'}}};

const BasicType* basic_type(std::string_view name) {
  const auto* const found = std::ranges::find(basic_types, name, &BasicType::name);
  return found == basic_types.end() ? nullptr : found;
}

// A message's length is told in two bytes.
constexpr std::size_t longest_content = 65535;
constexpr std::size_t deepest_nesting = 8;  // PX4's own go three deep

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-/.").find(c) != std::string_view::npos;
  });
}

/// Words that a firmware may print: no control characters but those that lay out text.
bool is_words(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte >= 0x20 && byte != 0x7F) || c == '\t' || c == '\n' || c == '\r' || c == '\x1b' ||
           c == '\0';
  });
}

/// Calls `use(type, name)` for each field of a format's text "type name;type name;". False where
/// the text, or `use`, says that it cannot be right.
template <class Use>
bool each_field(std::string_view fields, const Use& use) {
  while (!fields.empty()) {
    const std::size_t end = std::min(fields.find(';'), fields.size());
    const std::string_view field = fields.substr(0, end);
    fields.remove_prefix(std::min(end + 1, fields.size()));
    const std::size_t blank = field.find(' ');
    if (blank == std::string_view::npos) return false;
    const auto type = type_text(field.substr(0, blank));
    const std::string_view name = field.substr(blank + 1);
    if (!type || !is_name(name) || !use(*type, name)) return false;
  }
  return true;
}

}  // namespace

std::optional<TypeText> type_text(std::string_view text) {
  TypeText type{text};
  if (const std::size_t bracket = text.find('['); bracket != std::string_view::npos) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + bracket + 1, end, type.count);
    if (error != std::errc() || stop + 1 != end || *stop != ']') return std::nullopt;
    // Of none there are some: PX4 writes empty lines of its process list as char[0].
    if (type.count > longest_content) return std::nullopt;
    type.name = text.substr(0, bracket);
    type.is_array = true;
  }
  if (!is_name(type.name)) return std::nullopt;
  return type;
}

std::size_t size_of_basic(std::string_view type) {
  const BasicType* const basic = basic_type(type);
  return basic == nullptr ? 0 : basic->size;
}

std::optional<KeyAndValue> key_and_value(const std::byte* message, std::size_t offset) {
  const std::size_t length = length_of(message);
  if (length < offset + 1) return std::nullopt;
  const std::size_t key_size = byte_at(message + offset);
  if (key_size > length - offset - 1) return std::nullopt;
  const std::string_view text = text_from(message, offset + 1).substr(0, key_size);
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto type = type_text(text.substr(0, blank));
  KeyAndValue found;
  found.key = text.substr(blank + 1);
  if (!type || !is_name(found.key)) return std::nullopt;
  found.type = *type;
  found.value = message + offset + 1 + key_size;
  found.size = length - offset - 1 - key_size;
  const std::size_t size = size_of_basic(type->name);
  return size != 0 && found.size == size * type->count ? std::optional(found) : std::nullopt;
}

bool Definitions::is_format(const std::byte* message) {
  const std::string_view text = text_from(message, header_size);
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && is_name(text.substr(0, colon)) &&
         colon + 1 < text.size() &&
         each_field(text.substr(colon + 1), [](const TypeText&, std::string_view) { return true; });
}

Definitions::Change Definitions::take_format(const std::byte* message) {
  const std::string_view text = text_from(message, header_size);
  const std::size_t colon = text.find(':');
  const std::string name(text.substr(0, colon));
  const std::string fields(text.substr(colon + 1));
  const auto [entry, is_new] = formats_.try_emplace(name, fields);
  if (is_new) return {Outcome::defined};
  if (entry->second == fields || entry->second.empty()) return {};
  // One of the two is damaged, and nothing tells which. Without fields, nothing can be of it.
  entry->second.clear();
  return {Outcome::rejected,
          fmt::format("the format {} cannot be used: it contradicts an earlier one of that name",
                      name)};
}

bool Definitions::lay_out(std::string_view format, const std::string& prefix, Layout& layout,
                          std::size_t depth) const {
  const auto found = formats_.find(format);
  if (found == formats_.end() || depth > deepest_nesting) return false;
  return each_field(found->second, [&](const TypeText& type, std::string_view name) {
    const BasicType* const basic = basic_type(type.name);
    const bool is_text = basic != nullptr && basic->kind == 't';
    const bool is_padding = name.starts_with("_padding");
    const std::string path = prefix + std::string(name);
    // Padding and texts are one piece, whatever their length.
    const bool one_piece = is_text || is_padding || type.count == 1;
    const std::size_t pieces = one_piece ? 1 : type.count;
    for (std::size_t i = 0; i < pieces; ++i) {
      const std::string own = one_piece ? path : fmt::format("{}[{}]", path, i);
      if (basic == nullptr) {
        if (!lay_out(type.name, own + ".", layout, depth + 1)) return false;
        continue;
      }
      const std::size_t size = basic->size * (one_piece ? type.count : 1);
      if (!is_padding) layout.fields.push_back({own, basic->kind, data_at + layout.size, size});
      layout.size += size;
      if (!is_padding) layout.needed = layout.size;
      if (layout.size > longest_content) return false;
    }
    return true;
  });
}

void Definitions::forget(std::size_t number) {
  data_[number] = {};
  data_[number].contradicted = true;
}

Definitions::Change Definitions::take_subscription(const std::byte* message) {
  const int instance = byte_at(message + header_size);
  const std::size_t number = log_bytes::read<std::uint16_t>(message + header_size + 1);
  const std::string name(text_from(message, header_size + 3));
  if (number >= data_.size()) data_.resize(number + 1);
  if (data_[number].contradicted) return {};
  if (const LogMessageType* const before = data_[number].type; before != nullptr) {
    if (before->name == name && before->instance == instance) return {};
    const std::string earlier = before->name;
    forget(number);
    return {Outcome::rejected,
            fmt::format("messages number {} cannot be used: {} and {} both claim it", number,
                        earlier, name)};
  }
  Layout layout;
  if (!lay_out(name, "", layout, 0) || layout.needed == 0) {
    return {Outcome::rejected,
            fmt::format("messages {} cannot be used: their format cannot be resolved", name)};
  }
  types_.push_back({name, std::move(layout.fields), instance, std::nullopt});
  data_[number] = {layout.needed, layout.size, &types_.back(), false};
  return {Outcome::defined};
}

void Definitions::take_removal(const std::byte* message) {
  const std::size_t number = log_bytes::read<std::uint16_t>(message + header_size);
  if (number < data_.size()) data_[number] = {};
}

bool Framing::is_credible(const std::byte* message, std::size_t length,
                          const Definitions& known) const {
  const std::size_t size = length - header_size;
  switch (letter_of(message)) {
    case 'D':
      return size > 2 &&
             known.has_size(log_bytes::read<std::uint16_t>(message + header_size), size - 2);
    case 'F':
      return Definitions::is_format(message);
    case 'A':
      return size > 3 && known.knows_format(text_from(message, header_size + 3));
    case 'R':
      return size == 2 &&
             known.is_subscribed(log_bytes::read<std::uint16_t>(message + header_size));
    case 'B':
      return size >= flags_size && message == log_.data() + file_header_size;
    case 'I':
      return key_and_value(message, header_size).has_value();
    case 'M':
      return size > 1 && byte_at(message + header_size) <= 1 &&
             key_and_value(message, header_size + 1).has_value();
    case 'P':
    case 'Q': {
      const std::size_t key_at = header_size + (letter_of(message) == 'Q' ? 1 : 0);
      const auto parameter = key_and_value(message, key_at);
      return parameter && !parameter->type.is_array &&
             (parameter->type.name == "float" || parameter->type.name == "int32_t");
    }
    case 'L':
    case 'C': {
      const std::size_t words_at = header_size + (letter_of(message) == 'L' ? 9 : 11);
      if (length <= words_at) return false;
      const std::uint8_t level = byte_at(message + header_size);
      return level >= '0' && level <= '7' && is_words(text_from(message, words_at));
    }
    case 'S':
      return size == sync_magic.size() &&
             std::memcmp(message + header_size, sync_magic.data(), sync_magic.size()) == 0;
    case 'O':
      return size == 2;
    default:
      return false;
  }
}

std::size_t Framing::credible_at(std::size_t at, const Definitions& known) const {
  if (at + header_size > log_.size()) return 0;
  const std::byte* const message = log_.data() + at;
  const std::size_t length = length_of(message);
  if (length > log_.size() - at || !is_credible(message, length, known)) return 0;
  return length;
}

bool Framing::is_cut(std::size_t at, const Definitions& known) const {
  const std::size_t left = log_.size() - at;
  if (left < header_size) return true;
  const std::byte* const message = log_.data() + at;
  const std::size_t length = length_of(message);
  if (length <= left) return false;
  // What is there of its content.
  const std::string_view text(reinterpret_cast<const char*>(message + header_size),
                              left - header_size);
  const auto words_from = [text](std::size_t from) {
    return from >= text.size() || is_words(text.substr(from));
  };
  switch (letter_of(message)) {
    case 'D':
      return left < data_at || known.has_size(log_bytes::read<std::uint16_t>(message + header_size),
                                              length - data_at);
    case 'F':
      return words_from(0);
    case 'A':
      return words_from(header_size);
    case 'L':
    case 'C':
      return (text.empty() || (text[0] >= '0' && text[0] <= '7')) &&
             words_from(letter_of(message) == 'L' ? 9 : 11);
    case 'I':
    case 'P':
    case 'M':
    case 'Q': {
      const bool has_byte_before = letter_of(message) == 'M' || letter_of(message) == 'Q';
      const std::size_t size_at = has_byte_before ? 1 : 0;
      if (text.size() <= size_at) return true;
      if (letter_of(message) == 'M' && static_cast<unsigned char>(text[0]) > 1) return false;
      const std::size_t key_size = static_cast<unsigned char>(text[size_at]);
      const std::string_view key = text.substr(size_at + 1, key_size);
      constexpr std::size_t shortest_key = 7;  // "float A"
      return key_size >= shortest_key && key_size < length &&
             (key.empty() || is_name(key.substr(0, key.find_first_of(" ["))));
    }
    case 'S':
      return length == header_size + sync_magic.size() &&
             std::memcmp(text.data(), sync_magic.data(), text.size()) == 0;
    case 'O':
    case 'R':
      return length == data_at;
    default:
      return false;
  }
}

std::size_t Framing::damaged_at(std::size_t at, const Definitions& known) const {
  if (at + data_at > log_.size()) return 0;
  const std::byte* const message = log_.data() + at;
  const std::size_t length = length_of(message);
  if (length <= data_at || length > log_.size() - at) return 0;
  const std::size_t number = log_bytes::read<std::uint16_t>(message + header_size);
  // PX4 has some 300 topics, numbered from 0. A larger number is rather payload read as a header.
  constexpr std::size_t most_numbers = 1024;
  const bool lost_definition =
      letter_of(message) == 'D' && number < most_numbers && !known.is_subscribed(number);
  return lost_definition || known.has_size(number, length - data_at) ? length : 0;
}

bool Framing::may_follow(std::size_t at, const Definitions& known) const {
  constexpr int most_hops = 64;
  for (int hop = 0; hop < most_hops; ++hop) {
    if (at == log_.size() || is_cut(at, known)) return true;
    std::size_t length = credible_at(at, known);
    if (length != 0 && !is_doubtful(log_.data() + at)) return true;
    if (length == 0) length = damaged_at(at, known);
    if (length == 0) return false;
    at += length;
  }
  return false;
}

std::size_t Framing::next_message(std::size_t at, const Definitions& known) const {
  for (; at + header_size <= log_.size(); ++at) {
    const std::size_t length = credible_at(at, known);
    if (length == 0) continue;
    const bool is_followed = is_doubtful(log_.data() + at) ? credible_at(at + length, known) != 0
                                                           : may_follow(at + length, known);
    if (is_followed) return at;
  }
  return log_.size();
}

std::vector<std::size_t> section_ends(std::span<const std::byte> log) {
  std::vector<std::size_t> ends;
  constexpr std::size_t offsets_at = file_header_size + header_size + 16;
  constexpr std::size_t most_offsets = 3;
  const bool has_flags = log.size() >= offsets_at + most_offsets * 8 &&
                         letter_of(log.data() + file_header_size) == 'B' &&
                         length_of(log.data() + file_header_size) >= header_size + flags_size;
  for (std::size_t i = 0; has_flags && i < most_offsets; ++i) {
    const auto offset = log_bytes::read<std::uint64_t>(log.data() + offsets_at + 8 * i);
    const std::size_t before = ends.empty() ? offsets_at + most_offsets * 8 : ends.back();
    if (offset > before && offset < log.size()) ends.push_back(offset);
  }
  ends.push_back(log.size());
  return ends;
}

}  // namespace tethercalc::ulog
