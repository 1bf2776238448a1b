// JSON that knows the line of each of its values, so that a message can name it. JSON is read and
// written here alone: the library's parser and printer take long to compile.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {

/// A parsed document. Pointers are JSON pointers (RFC 6901); "" is the whole document.
struct JsonDocument {
  std::string name;  ///< of the file, as messages call it
  nlohmann::ordered_json root;
  std::map<std::string, std::size_t, std::less<>> lines;    ///< pointer → line, counted from 1
  std::map<std::string, std::string, std::less<>> options;  ///< pointer → the option that set it
  std::vector<InputProblem> problems;  ///< that leave the rest readable: duplicate keys

  /// "file:line /pointer", or the option that set the value. What is not there is placed at the
  /// nearest value around it.
  [[nodiscard]] std::string where(std::string_view pointer) const;
};

/// Whether messages show the line at fault. A file that a spec of a stranger names may be one that
/// is nobody's business, which a message would give away.
enum class Quoting { line, nothing };

/// Parses JSON text. A UTF-8 byte order mark is skipped: some editors write one unasked.
/// Throws InputError with line, column and an excerpt where the text is not JSON (truncated, NaN,
/// comments, trailing text, NUL, invalid UTF-8, UTF-16, a number beyond double) or is nested deeper
/// than 32 levels.
JsonDocument parse_json(std::string_view text, std::string name, Quoting quoting = Quoting::line);

/// The value of a text that is known to be JSON.
nlohmann::ordered_json json_of(std::string_view text);

/// JSON as answers and files show it, a line a value.
std::string json_text(const nlohmann::ordered_json& json);

/// The same on one line.
std::string json_line(const nlohmann::ordered_json& json);

/// A number or a word; null where the result does not exist.
nlohmann::ordered_json result_json(const ResultValue& value);

/// `pointer` with one more key, escaped as RFC 6901 asks.
std::string child_pointer(std::string_view pointer, std::string_view key);

/// The last key of `pointer`, as escaped there.
std::string_view last_key(std::string_view pointer);

/// Whether `pointer` leads to something within what `top` leads to.
bool is_below(std::string_view pointer, std::string_view top);

/// A value as a message shows it: compact, on one line, no longer than about 60 characters, safe
/// to print whatever bytes it holds.
std::string shown(const nlohmann::ordered_json& value);

/// What a file is called without its folders and suffix: "x500" of "designs/x500.json".
std::string file_stem(std::string_view name);

/// Whether `text` is valid UTF-8, without which no JSON can hold it.
bool is_utf8(const std::string& text);

/// `text` with what is not UTF-8 replaced by U+FFFD: names of files may hold any bytes.
std::string as_utf8(const std::string& text);

/// "the number 7", "the text "a"", "an object" …
std::string type_name(const nlohmann::ordered_json& value);

}  // namespace tethercalc
