#include "report/characters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tethercalc {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

/// The character that `text` begins with and its length in bytes; U+FFFD and 1 where the bytes are
/// no UTF-8 (RFC 3629: shortest form, no surrogates).
std::pair<std::uint32_t, std::size_t> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  constexpr std::pair bad{std::uint32_t{0xFFFD}, std::size_t{1}};
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return bad;
  std::uint32_t character = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return bad;
    character = character << 6 | (byte(i) & 0x3F);
  }
  constexpr std::array<std::uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (character < least[length] || character > 0x10FFFF || surrogate) return bad;
  return {character, length};
}

/// What XML, terminals or readers stumble over: controls, non-characters, and marks that turn the
/// direction of writing.
bool unprintable(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || (c >= 0x200E && c <= 0x200F) ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069) ||
         (c >= 0xFDD0 && c <= 0xFDEF) || (c & 0xFFFE) == 0xFFFE;
}

bool is_white_space(std::uint32_t c) { return c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

void for_each_character(std::string_view text,
                        const std::function<void(std::uint32_t, std::string_view)>& take) {
  while (!text.empty()) {
    const auto [character, length] = first_character(text);
    take(character, character == 0xFFFD ? replacement : text.substr(0, length));
    text.remove_prefix(length);
  }
}

int columns_of(std::uint32_t c) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr std::array<Range, 4> put_on{
      {{0x0300, 0x036F}, {0x200B, 0x200D}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}}};
  constexpr std::array<Range, 10> wide{{{0x1100, 0x115F},
                                        {0x2E80, 0x303E},
                                        {0x3041, 0xA4CF},
                                        {0xAC00, 0xD7A3},
                                        {0xF900, 0xFAFF},
                                        {0xFE30, 0xFE6F},
                                        {0xFF00, 0xFF60},
                                        {0xFFE0, 0xFFE6},
                                        {0x1F300, 0x1FAFF},
                                        {0x20000, 0x3FFFD}}};
  const auto holds = [c](const Range& range) { return range.first <= c && c <= range.last; };
  if (std::ranges::any_of(put_on, holds)) return 0;
  return std::ranges::any_of(wide, holds) ? 2 : 1;
}

int columns_of(std::string_view text) {
  int columns = 0;
  for_each_character(text, [&](std::uint32_t c, std::string_view) { columns += columns_of(c); });
  return columns;
}

std::string cut_to_columns(std::string_view text, int room) {
  if (columns_of(text) <= room) return std::string(text);
  std::string out;
  int columns = 1;  // of the ellipsis
  bool full = false;
  for_each_character(text, [&](std::uint32_t c, std::string_view bytes) {
    columns += columns_of(c);
    full = full || columns > room;
    if (!full) out += bytes;
  });
  return out + "…";
}

std::string printable(std::string_view text, std::size_t longest) {
  std::vector<std::string_view> characters;
  for_each_character(text, [&](std::uint32_t c, std::string_view bytes) {
    characters.push_back(is_white_space(c) ? " " : unprintable(c) ? replacement : bytes);
  });
  if (characters.size() > longest) {
    characters.resize(longest - 1);
    characters.emplace_back("…");
  }
  std::string out;
  for (const std::string_view character : characters) out += character;
  return out;
}

std::string printable_lines(std::string_view text) {
  std::string out;
  for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
    out += printable(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return out + printable(text);
}

std::string markup_text(std::string_view text) {
  std::string out;
  for_each_character(text, [&out](std::uint32_t c, std::string_view bytes) {
    constexpr std::string_view special = "&<>\"'";
    constexpr std::array entities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
    if (const std::size_t at = special.find(bytes); at != std::string_view::npos) {
      out += entities.at(at);
    } else {
      out += unprintable(c) && !is_white_space(c) ? replacement : bytes;
    }
  });
  return out;
}

std::string visible_json(std::string_view json) {
  std::string out;
  for_each_character(json, [&out](std::uint32_t c, std::string_view bytes) {
    // The rest of the planes has only non-characters to hide, which stay for others to replace.
    const bool hidden = unprintable(c) && !is_white_space(c) && c <= 0xFFFF;
    if (hidden) {
      out += fmt::format("\\u{:04x}", c);
    } else {
      out += bytes;
    }
  });
  return out;
}

}  // namespace tethercalc
