// Values of a JSON object held against the table that describes its fields.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/json_document.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {

/// The problems found so far. Keeps the first `most`: nobody reads more, and a file that is
/// something else altogether would have one a line.
class Problems {
 public:
  /// `in_all` is where the message about the others is said to stand.
  explicit Problems(std::size_t most = 100, std::string in_all = "in all")
      : most_(most), in_all_(std::move(in_all)) {}

  void add(std::string where, std::string message);
  /// The same, returning the nothing that stands for what was refused.
  std::nullopt_t refuse(std::string where, std::string message) {
    add(std::move(where), std::move(message));
    return std::nullopt;
  }
  void add(std::vector<InputProblem> problems);

  /// Calls `step`; false where it threw an InputError, whose problems then are among these.
  template <typename Step>
  bool succeeds(Step step) {
    try {
      step();
      return true;
    } catch (const InputError& error) {
      add(error.problems());
      return false;
    }
  }

  [[nodiscard]] std::size_t count() const { return kept_.size() + omitted_; }

  /// Throws InputError where there are any.
  void throw_if_any() const;

 private:
  std::size_t most_;
  std::string in_all_;
  std::vector<InputProblem> kept_;
  std::size_t omitted_ = 0;
};

/// A value and where it stands.
struct JsonPlace {
  const JsonDocument* document = nullptr;
  const nlohmann::ordered_json* value = nullptr;  ///< null: not given
  std::string pointer;

  [[nodiscard]] bool given() const { return value != nullptr; }
  [[nodiscard]] std::string where() const { return document->where(pointer); }
  /// Of a list, the element with that index.
  [[nodiscard]] JsonPlace element(std::size_t i) const {
    return {document, &(*value)[i], pointer + "/" + std::to_string(i)};
  }
};

/// The values of `fields` in the object at `object`, in the order of the fields, groups within
/// groups included. Reports what is no object, unknown keys with the closest known one, and missing
/// required fields.
std::vector<JsonPlace> field_places(const JsonPlace& object, std::span<const SpecField> fields,
                                    Problems& problems);

/// The number at a place in the field's practical unit; nothing, with the reason among the
/// problems, where it is none or not allowed. Nothing and no problem where it is not given, or null
/// where the field is optional.
std::optional<double> checked_number(const JsonPlace& place, const SpecField& field,
                                     Problems& problems);

/// "1.71 is out of range; allowed is …" of a number, as written, that is not in the field's range,
/// with what was probably meant.
[[nodiscard]] std::string out_of_range(const SpecField& field, double value,
                                       std::string_view written);

/// Throws InputError, about `option`, where `value` is not in the field's range.
void check_range(const char* option, double value, const SpecField& field);

/// The same of what is no field: from `least` to `most`, the unit said where it has one.
void check_range(const char* option, double value, double least, double most, const char* unit);

/// "; did you mean 1710? The unit is the gram" for 1.71, which is out of the field's range, where
/// that many kilograms are not; else empty.
[[nodiscard]] std::string meant_in_thousands(const SpecField& field, double value);

/// The finite number that the whole of `text` is; nothing where it is none.
std::optional<double> parsed_number(std::string_view text);

/// Which of `words` was typed, where a hyphen may stand for an underscore; nothing where it is
/// none.
[[nodiscard]] std::optional<std::size_t> typed_word(std::string text,
                                                    std::span<const std::string> words);

/// "expected "hover" or "forward", found …; did you mean …" of a text that is none of `words`, of
/// which there are two at least; `found` is what stands there, as people read it.
[[nodiscard]] std::string no_such_word(std::string_view text, std::span<const std::string> words,
                                       std::string_view found);

/// The parts of `text` between separators, at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The text at a place; empty where it is not given or, with a problem, is no text.
std::string checked_text(const JsonPlace& place, Problems& problems);

}  // namespace tethercalc
