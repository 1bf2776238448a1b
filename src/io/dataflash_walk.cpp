#include "io/dataflash_walk.hpp"

#include <utility>

namespace tethercalc::dataflash {
namespace {

// Layout of an FMT message behind its header: B type, B length, n name, N format, Z labels.
constexpr std::size_t type_at = header_size;
constexpr std::size_t length_at = type_at + 1;
constexpr std::size_t name_at = length_at + 1;
constexpr std::size_t name_size = 4;
constexpr std::size_t format_at = name_at + name_size;
constexpr std::size_t format_size = 16;
constexpr std::size_t labels_at = format_at + format_size;
constexpr std::size_t labels_size = 64;
static_assert(labels_at + labels_size == fmt_length);

std::string_view name_in(const std::byte* fmt) { return text_at(fmt + name_at, name_size); }
std::string_view format_in(const std::byte* fmt) { return text_at(fmt + format_at, format_size); }
std::string_view labels_in(const std::byte* fmt) { return text_at(fmt + labels_at, labels_size); }

/// The name as one number, to compare it with many.
std::uint32_t name_number(const std::byte* fmt) {
  const std::string_view name = name_in(fmt);
  std::uint32_t number = 0;
  std::memcpy(&number, name.data(), name.size());
  return number;
}

bool same_definition(const std::byte* a, const std::byte* b) {
  return a[length_at] == b[length_at] && name_in(a) == name_in(b) && format_in(a) == format_in(b) &&
         labels_in(a) == labels_in(b);
}

/// Whether the first field is of that kind and has that name.
bool begins_with(const std::byte* fmt, char kind, std::string_view label) {
  const std::string_view labels = labels_in(fmt);
  return format_in(fmt).starts_with(kind) && labels.substr(0, labels.find(',')) == label;
}

bool is_name_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

/// Why a definition cannot be right, or an empty text. The length is given twice, once as a number
/// and once by the fields; where the two disagree, one of them is damaged. (A format without any
/// fields, or with a kind not known here, leaves only the number.)
std::string_view fault_in(const std::byte* fmt) {
  const std::string_view name = name_in(fmt);
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_name_character)) {
    return "its name is not made of letters and digits";
  }
  const std::string_view labels = labels_in(fmt);
  if (!std::all_of(labels.begin(), labels.end(), [](char c) { return c > 0x20 && c < 0x7F; })) {
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

constexpr std::array<std::byte, fmt_length> built_in_fmt = make_definition_of_fmt();

}  // namespace

const std::byte* definition_of_fmt() { return built_in_fmt.data(); }

std::size_t size_of_kind(char kind) {
  static constexpr std::pair<std::string_view, std::size_t> all[] = {
      {"bBM", 1}, {"hHcCg", 2}, {"iIfLeEn", 4}, {"qQd", 8}, {"N", 16}, {"aZ", 64}};
  for (const auto& [kinds, bytes] : all) {
    if (kinds.find(kind) != std::string_view::npos) return bytes;
  }
  return 0;
}

DataFlashFormat parse_format(const std::byte* message) {
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
    format.fields.push_back({std::string(labels.substr(0, comma)), kind, offset});
    labels.remove_prefix(comma == std::string_view::npos ? labels.size() : comma + 1);
    offset += size;
  }
  return format;
}

Definitions::Definitions() {
  length_[fmt_type] = fmt_length;
  definition_[fmt_type] = built_in_fmt.data();
  settled_[fmt_type] = true;
  name_[fmt_type] = name_number(built_in_fmt.data());
}

Definitions::Change Definitions::take(const std::byte* message) {
  const auto type = std::to_integer<std::uint8_t>(message[type_at]);
  if (type == fmt_type) {
    // Every log begins with the definition of FMT itself, so here one may begin behind another, and
    // its numbers may mean other messages.
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

std::optional<std::uint8_t> Definitions::settled_type_called(std::uint32_t name) const {
  for (std::size_t type = 0; type < name_.size(); ++type) {
    if (name_[type] == name && settled_[type]) return static_cast<std::uint8_t>(type);
  }
  return std::nullopt;
}

void Definitions::forget(std::uint8_t type) {
  definition_[type] = nullptr;
  length_[type] = 0;
  name_[type] = 0;
}

Framing::Framing(std::span<const std::byte> log) : log_(log), filler_(log.size()) {
  // Memory that was never written reads as all zeros or all ones. A run shorter than the longest
  // message is not taken for it: it may be the end of one.
  constexpr std::size_t shortest_run = 256;
  if (log.empty() || (log.back() != std::byte{0x00} && log.back() != std::byte{0xFF})) return;
  std::size_t start = log.size();
  while (start > 0 && log[start - 1] == log.back()) --start;
  if (log.size() - start >= shortest_run) filler_ = start;
}

bool Framing::is_followed(std::size_t message, std::size_t at, const Definitions& known) const {
  // Filler must begin right here: if the message seems to end inside it, its own end may be filler.
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

std::size_t Framing::next_mark(std::size_t from, std::size_t end) const {
  const void* const found =
      std::memchr(log_.data() + from, std::to_integer<int>(mark_first), end - from);
  if (found == nullptr) return end;
  return static_cast<std::size_t>(static_cast<const std::byte*>(found) - log_.data());
}

bool Framing::has_messages_within(std::size_t at, std::size_t length, const Definitions& known,
                                  const TimeGuard& guard) const {
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

std::size_t Framing::next_message(std::size_t at, const Definitions& known) const {
  at = next_mark(at, log_.size());
  while (at < log_.size() && message_at(at, known) == 0) at = next_mark(at + 1, log_.size());
  return at;
}

SkippedBytes Framing::skipped(std::size_t from, std::size_t to) const {
  SkippedBytes lost{from, to - from, 0};
  if (from >= filler_) return lost;
  for (std::size_t i = from; i + 1 < to; ++i) lost.messages += mark_at(i) ? 1 : 0;
  if (lost.messages == 0) lost.messages = 1;
  return lost;
}

}  // namespace tethercalc::dataflash
