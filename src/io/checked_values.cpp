#include "io/checked_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/closest_name.hpp"
#include "io/decimal_number.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

/// Walks an object and the groups in it.
class FieldFinder {
 public:
  FieldFinder(const JsonPlace& object, std::span<const SpecField> fields, Problems& problems)
      : object_(object), fields_(fields), problems_(problems), places_(fields.size()) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      places_[i] = {object.document, nullptr, object.pointer + std::string(fields[i].pointer)};
    }
  }

  std::vector<JsonPlace> find() {
    if (walk(*object_.value, "")) report_missing();
    return std::move(places_);
  }

 private:
  /// `group` is the pointer below the object; false where the value is no object.
  bool walk(const Json& value, const std::string& group) {
    if (!value.is_object()) {
      problems_.add(object_.document->where(object_.pointer + group),
                    fmt::format("expected an object with {}, found {}",
                                fmt::join(keys_of(group), ", "), type_name(value)));
      unusable_groups_.push_back(group);
      return false;
    }
    for (const auto& [key, member] : value.items()) {
      const std::string pointer = child_pointer(group, key);
      if (const auto index = index_of(pointer)) {
        places_[*index].value = &member;
      } else if (is_group(pointer)) {
        walk(member, pointer);
      } else {
        report_unknown(group, key, pointer);
      }
    }
    return true;
  }

  [[nodiscard]] std::optional<std::size_t> index_of(std::string_view pointer) const {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i].pointer == pointer) return i;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_group(std::string_view pointer) const {
    return std::ranges::any_of(
        fields_, [&](const SpecField& field) { return is_below(field.pointer, pointer); });
  }

  /// The keys that may stand in a group.
  [[nodiscard]] std::vector<std::string> keys_of(std::string_view group) const {
    std::vector<std::string> keys;
    for (const SpecField& field : fields_) {
      if (!is_below(field.pointer, group)) continue;
      const std::string_view rest = field.pointer.substr(group.size() + 1);
      std::string key(rest.substr(0, rest.find('/')));
      if (keys.empty() || keys.back() != key) keys.push_back(std::move(key));
    }
    return keys;
  }

  void report_unknown(const std::string& group, const std::string& key,
                      const std::string& pointer) {
    problems_.add(object_.document->where(object_.pointer + pointer),
                  fmt::format("unknown key {}{}", shown(key), unknown_hint(group, key)));
  }

  [[nodiscard]] std::string unknown_hint(const std::string& group, const std::string& key) const {
    for (const SpecField& field : fields_) {
      if (last_key(field.pointer) == key) {
        return fmt::format("; it belongs at {}{}", object_.pointer, field.pointer);
      }
    }
    const std::vector<std::string> keys = keys_of(group);
    const std::string hint = did_you_mean(key, keys);
    return hint.empty() ? fmt::format("; known here: {}", fmt::join(keys, ", ")) : hint;
  }

  void report_missing() {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const SpecField& field = fields_[i];
      if (places_[i].given() || !field.required() || in_unusable_group(field.pointer)) continue;
      if (may_be_left_out(field) && !has_group_of(field)) continue;
      problems_.add(places_[i].where(),
                    fmt::format("\"{}\" is missing{}{}: {}", last_key(field.pointer),
                                field.unit.empty() ? "" : ", in ", field.unit, field.help));
    }
  }

  /// Whether the group that the field stands in is there, if only empty.
  [[nodiscard]] bool has_group_of(const SpecField& field) const {
    const std::string_view group = field.pointer.substr(0, field.pointer.rfind('/'));
    return object_.value->contains(Json::json_pointer(std::string(group)));
  }

  [[nodiscard]] bool in_unusable_group(std::string_view pointer) const {
    return std::ranges::any_of(unusable_groups_,
                               [&](const std::string& group) { return is_below(pointer, group); });
  }

  const JsonPlace& object_;
  std::span<const SpecField> fields_;
  Problems& problems_;
  std::vector<JsonPlace> places_;
  std::vector<std::string> unusable_groups_;
};

/// Control characters of ASCII and of Latin 1 (U+0080 to U+009F), which command terminals. Ends of
/// lines and tabs are for people.
bool commands_a_terminal(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == 0x7f || (byte < 0x20 && byte != '\n' && byte != '\t')) return true;
    const unsigned next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte == 0xc2 && next >= 0x80 && next <= 0x9f) return true;
  }
  return false;
}

std::string joined(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.where + ": " + problem.message;
  }
  return text;
}

}  // namespace

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

void Problems::add(std::string where, std::string message) {
  if (kept_.size() == most_) {
    ++omitted_;
    return;
  }
  kept_.push_back({std::move(where), std::move(message)});
}

void Problems::add(std::vector<InputProblem> problems) {
  for (InputProblem& problem : problems) add(std::move(problem.where), std::move(problem.message));
}

void Problems::throw_if_any() const {
  if (kept_.empty()) return;
  std::vector<InputProblem> problems = kept_;
  if (omitted_ > 0) {
    problems.push_back({in_all_, fmt::format("and {} more problems", omitted_)});
  }
  throw InputError(std::move(problems));
}

std::vector<JsonPlace> field_places(const JsonPlace& object, std::span<const SpecField> fields,
                                    Problems& problems) {
  return FieldFinder(object, fields, problems).find();
}

std::optional<double> checked_number(const JsonPlace& place, const SpecField& field,
                                     Problems& problems) {
  if (!place.given()) return std::nullopt;
  const Json& value = *place.value;
  if (field.kind == FieldKind::optional_number && value.is_null()) return std::nullopt;
  const std::string in_unit =
      field.unit.empty() ? std::string() : fmt::format(" in {}", field.unit);
  if (!value.is_number()) {
    const char* kind = field.kind == FieldKind::integer ? "a whole number" : "a number";
    return problems.refuse(place.where(),
                           fmt::format("expected {}{}, found {}; allowed is {}", kind, in_unit,
                                       type_name(value), describe_range(field)));
  }
  const double number = value.get<double>();
  if (field.kind == FieldKind::integer && number != std::floor(number)) {
    return problems.refuse(place.where(), fmt::format("{} is not a whole number; allowed is {}",
                                                      shown(value), describe_range(field)));
  }
  if (!field.range.contains(number)) {
    return problems.refuse(place.where(), out_of_range(field, number, shown(value)));
  }
  return number;
}

std::string out_of_range(const SpecField& field, double value, std::string_view written) {
  return fmt::format("{} is out of range; allowed is {}{}", written, describe_range(field),
                     meant_in_thousands(field, value));
}

void check_range(const char* option, double value, const SpecField& field) {
  if (field.range.contains(value)) return;
  throw InputError(option, out_of_range(field, value, fmt::format("{:g}", value)));
}

void check_range(const char* option, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw InputError(option, fmt::format("{:g} is out of range; allowed is {} to {}{}{}", value,
                                       least, most, *unit == '\0' ? "" : " ", unit));
}

std::string meant_in_thousands(const SpecField& field, double value) {
  const bool kilograms = field.unit == "g" && !field.range.contains(value) && value > 0 &&
                         field.range.contains(1000 * value);
  return kilograms ? fmt::format("; did you mean {:g}? The unit is the gram", 1000 * value) : "";
}

std::optional<double> parsed_number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = read_number(text.data(), end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::size_t> typed_word(std::string text, std::span<const std::string> words) {
  std::ranges::replace(text, '-', '_');
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) return std::nullopt;
  return static_cast<std::size_t>(found - words.begin());
}

std::string no_such_word(std::string_view text, std::span<const std::string> words,
                         std::string_view found) {
  return fmt::format("expected \"{}\" or \"{}\", found {}{}",
                     fmt::join(words.begin(), words.end() - 1, "\", \""), words.back(), found,
                     did_you_mean(text, words));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string checked_text(const JsonPlace& place, Problems& problems) {
  if (!place.given()) return {};
  if (!place.value->is_string()) {
    problems.add(place.where(), "expected a text in quotes, found " + type_name(*place.value));
    return {};
  }
  std::string text = place.value->get<std::string>();
  if (commands_a_terminal(text)) {
    problems.add(place.where(),
                 "a text may not hold control characters other than line ends and tabs");
    return {};
  }
  return text;
}

}  // namespace tethercalc
