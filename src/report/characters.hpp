// Texts of strangers (names of designs, motors, files) made fit to print and to stand in markup.
#pragma once

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

/// JSON text with everything that `printable` would replace written as \uXXXX, so that it still
/// says the same.
std::string visible_json(std::string_view json);

}  // namespace tethercalc
