// Texts of strangers (names of designs, motors, files) made fit to print and to stand in markup.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace tethercalc {

/// One line of printable characters, at most `longest` of them, the last one then "…". Line breaks
/// and tabs become spaces; U+FFFD stands for what is no UTF-8, for control characters, and for
/// marks that turn the direction of writing, with which a name could rearrange the text around it.
std::string printable(std::string_view text,
                      std::size_t longest = std::numeric_limits<std::size_t>::max());

/// The same for several lines, which stay lines.
std::string printable_lines(std::string_view text);

/// `text` as it may stand in HTML and XML, in content and between quotes of an attribute: no
/// markup, the same replacements as in `printable`, but with line breaks and tabs kept.
std::string markup_text(std::string_view text);

/// Calls `take` with each character of `text` and its bytes, which are those of U+FFFD where there
/// is no character.
void for_each_character(std::string_view text,
                        const std::function<void(std::uint32_t, std::string_view)>& take);

/// How many columns of a terminal the character takes: 2 where it is as wide as high (East Asian
/// scripts, emoji; after Unicode's EastAsianWidth), 0 where it is put on the one before it, else 1.
int columns_of(std::uint32_t character);

/// The columns of all characters of `text`.
int columns_of(std::string_view text);

/// As much of `text` as has room in `room` columns, the last one then "…".
std::string cut_to_columns(std::string_view text, int room);

/// JSON text with everything that `printable` would replace written as \uXXXX, so that it still
/// says the same.
std::string visible_json(std::string_view json);

}  // namespace tethercalc
