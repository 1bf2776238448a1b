#include "io/spec_overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

bool is_at_or_below(std::string_view pointer, std::string_view top) {
  return pointer == top || is_below(pointer, top);
}

std::string pointer_of(std::string_view dotted) {
  if (dotted.starts_with('/')) return std::string(dotted);
  std::string pointer = "/" + std::string(dotted);
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return pointer;
}

bool is_list(FieldKind kind) {
  return kind == FieldKind::motor_points || kind == FieldKind::efficiency ||
         kind == FieldKind::converter_masses;
}

std::string_view without_index(std::string_view rest) {
  const std::size_t end = std::min(rest.find('/', 1), rest.size());
  const bool is_index = rest.substr(1, end - 1).find_first_not_of("0123456789") == rest.npos;
  return is_index ? rest.substr(end) : rest;
}

/// True where some spec may have a value at `pointer`.
bool may_exist(std::string_view pointer, std::span<const SpecField> fields) {
  return std::any_of(fields.begin(), fields.end(), [&](const SpecField& field) {
    if (is_at_or_below(field.pointer, pointer)) return true;
    if (!is_at_or_below(pointer, field.pointer)) return false;
    std::string_view rest = pointer.substr(field.pointer.size());
    if (is_list(field.kind)) rest = without_index(rest);
    return rest.empty() || may_exist(rest, object_fields(field.kind));
  });
}

/// The value at `key` of `parent`, made where an object lacks it; null where there can be none.
Json* member_of(Json& parent, const std::string& key) {
  if (parent.is_object()) return &parent[key];
  if (!parent.is_array()) return nullptr;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  const bool usable = error == std::errc() && end == key.data() + key.size();
  return usable && index < parent.size() ? &parent[index] : nullptr;
}

/// JSON, or else a text as it stands. What opens a bracket is meant as JSON: its faults are thrown.
Json value_of(const std::string& text, const std::string& option) {
  try {
    JsonDocument value = parse_json(text, option);
    if (!value.problems.empty()) throw InputError(value.problems);
    return std::move(value.root);
  } catch (const InputError&) {
    if (text.starts_with('{') || text.starts_with('[')) throw;
    return text;
  }
}

void forget_lines(JsonDocument& document, std::string_view pointer) {
  const auto replaced = [&](const auto& entry) { return is_at_or_below(entry.first, pointer); };
  std::erase_if(document.lines, replaced);
  std::erase_if(document.options, replaced);
}

void apply_override(JsonDocument& document, const std::string& override_text, Problems& problems) {
  const std::string option = "--set " + override_text;
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) {
    problems.add(option, "expected path=value, such as supply.voltage_V=60");
    return;
  }
  if (!is_utf8(override_text)) {
    problems.add("--set " + shown(override_text), "is not valid UTF-8");
    return;
  }
  const std::string path = override_text.substr(0, equals);
  const std::string pointer = pointer_of(path);
  if (!may_exist(pointer, spec_fields())) {
    problems.add(option, no_such_field(path));
    return;
  }
  Json new_value;
  const bool read =
      problems.succeeds([&] { new_value = value_of(override_text.substr(equals + 1), option); });
  if (!read) return;
  Json* value = &document.root;
  std::string walked;
  for (const std::string_view part : split(std::string_view(pointer).substr(1), '/')) {
    const std::string key(part);
    if (value->is_null()) *value = Json::object();
    Json* member = member_of(*value, key);
    if (member == nullptr) {
      const std::string holder = walked.empty() ? "the spec" : dot_path(walked);
      problems.add(option, fmt::format("there is no {} in {}, which is {}", shown(key), holder,
                                       type_name(*value)));
      return;
    }
    value = member;
    walked = child_pointer(walked, key);
  }
  *value = std::move(new_value);
  forget_lines(document, pointer);
  document.options[pointer] = option;
}

}  // namespace

void apply_overrides(JsonDocument& document, std::span<const std::string> overrides,
                     Problems& problems) {
  for (const std::string& override_text : overrides) {
    apply_override(document, override_text, problems);
  }
}

}  // namespace tethercalc
