#include "tethercalc/io/design_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "io/checked_values.hpp"
#include "io/embedded_files.hpp"
#include "io/entry_readers.hpp"
#include "io/json_document.hpp"
#include "io/spec_paths.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

// --- `--set path=value`: a spec edited from the command line -----------------------------------

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

/// Edits `document` as `override_text` says. Reports a missing "=", a path that no spec has, with
/// the closest that one may have, and a path below something that is no object or list. The value
/// itself is left to the reader.
void apply_override(JsonDocument& document, const std::string& override_text, Problems& problems) {
  const std::string option = "--set " + override_text;
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return problems.add(option, "expected path=value, such as supply.voltage_V=60");
  }
  if (!is_utf8(override_text)) {
    return problems.add("--set " + shown(override_text), "is not valid UTF-8");
  }
  const std::string path = override_text.substr(0, equals);
  const std::string pointer = pointer_of(path);
  if (!may_be_in_spec(pointer)) return problems.add(option, no_such_field(path));
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
      return problems.add(option, fmt::format("there is no {} in {}, which is {}", shown(key),
                                              holder, type_name(*value)));
    }
    value = member;
    walked = child_pointer(walked, key);
  }
  *value = std::move(new_value);
  forget_lines(document, pointer);
  document.options[pointer] = option;
}

// --- The fields of a spec -----------------------------------------------------------------------

/// A boolean, or one of the words of the field's kind.
void read_word(const JsonPlace& place, const SpecField& field, Design& design, Problems& problems) {
  const auto words = field_words(field.kind);
  const bool quoted = field.kind != FieldKind::boolean;
  std::string found;
  if (quoted && place.value->is_string()) found = place.value->get<std::string>();
  if (!quoted && place.value->is_boolean()) found = place.value->dump();
  const auto word = std::ranges::find(words, found);
  if (word != words.end()) {
    set_word(design, field, static_cast<std::size_t>(word - words.begin()));
  } else if (quoted) {
    problems.add(place.where(), no_such_word(found, words, type_name(*place.value)));
  } else {
    problems.add(place.where(), "expected true or false, found " + type_name(*place.value));
  }
}

/// Reads a list of objects of two numbers each, in SI, and makes a `Point` of each. `put` takes the
/// list and throws std::invalid_argument where it cannot be.
template <class Point, class Put>
void read_points(const JsonPlace& place, std::span<const SpecField> fields, Problems& problems,
                 const Put& put) {
  const std::size_t before = problems.count();
  std::vector<Point> points;
  for (std::size_t i = 0; i < place.value->size(); ++i) {
    const std::vector<JsonPlace> places = field_places(place.element(i), fields, problems);
    const auto x = checked_number(places[0], fields[0], problems);
    const auto y = checked_number(places[1], fields[1], problems);
    if (x && y) points.push_back({*x * fields[0].si_factor, *y * fields[1].si_factor});
  }
  if (problems.count() > before) return;
  try {
    put(std::move(points));
  } catch (const std::invalid_argument& error) {
    problems.add(place.where(), error.what());
  }
}

void read_efficiency(const JsonPlace& place, const SpecField& field, Converter& converter,
                     Problems& problems) {
  if (place.value->is_number()) {
    if (const auto constant = checked_number(place, field, problems)) {
      converter.efficiency = {{0.0, *constant}};
    }
  } else if (!place.value->is_array()) {
    problems.add(place.where(),
                 fmt::format("expected a number {} or a list of {{output_W, efficiency}}, found {}",
                             describe_range(field), type_name(*place.value)));
  } else if (place.value->empty()) {
    problems.add(place.where(), "an efficiency curve needs at least one point");
  } else {
    read_points<EfficiencyPoint>(place, object_fields(FieldKind::efficiency), problems,
                                 [&](auto points) {
                                   Converter candidate = converter;
                                   candidate.efficiency = std::move(points);
                                   validate(candidate);
                                   converter = std::move(candidate);
                                 });
  }
}

void read_converter_masses(const JsonPlace& place, Converter& converter, Problems& problems) {
  if (!place.value->is_array()) {
    problems.add(place.where(),
                 fmt::format("expected a list of {{rated_output_W, mass_g}}, found {}",
                             type_name(*place.value)));
    return;
  }
  read_points<ConverterMassPoint>(place, object_fields(FieldKind::converter_masses), problems,
                                  [&](auto points) {
                                    validate(points);
                                    converter.masses = std::move(points);
                                  });
}

/// Fills a DesignFile field by field.
class SpecReader {
 public:
  SpecReader(const JsonDocument& document, DesignFile& result, Problems& problems)
      : document_(document), result_(result), problems_(problems) {}

  void read() {
    const std::size_t before = problems_.count();
    const auto fields = spec_fields();
    const std::vector<JsonPlace> places =
        field_places({&document_, &document_.root, ""}, fields, problems_);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (places[i].given()) {
        read_field(places[i], fields[i]);
      } else if (!fields[i].required()) {
        const Json default_value = json_of(fields[i].default_json);
        read_field({&document_, &default_value, places[i].pointer}, fields[i]);
      }
    }
    if (problems_.count() == before) estimate_drag(fields, places);
    // Conflicts between fields mean something only where each of them was read.
    if (problems_.count() > before) return;
    for (const FieldConflict& conflict : find_conflicts(result_.design)) {
      problems_.add(document_.where(conflict.pointer), conflict.message);
    }
  }

 private:
  void read_field(const JsonPlace& place, const SpecField& field) {
    Design& design = result_.design;
    switch (field.kind) {
      case FieldKind::number:
      case FieldKind::optional_number:
      case FieldKind::integer:
        if (const auto value = checked_number(place, field, problems_)) {
          set_field(design, field, *value);
        }
        return;
      case FieldKind::boolean:
      case FieldKind::condition:
      case FieldKind::strength_material:
      case FieldKind::tether_model:
      case FieldKind::wind_profile:
        return read_word(place, field, design, problems_);
      case FieldKind::text:
        if (const std::string text = checked_text(place, problems_);
            field.pointer == "/name" && !text.empty()) {
          result_.name = text;
        }
        return;
      case FieldKind::converter_masses:
        return read_converter_masses(place, design.supply.converter, problems_);
      case FieldKind::efficiency:
        return read_efficiency(place, field, design.supply.converter, problems_);
      case FieldKind::motor:
        read_entry(place, result_.motor);
        // What rankings call a motor that stands in the spec itself.
        if (std::string& id = result_.motor.id; id.empty()) {
          id = result_.motor.name.empty() ? "own motor" : result_.motor.name;
        }
        result_.warnings = result_.motor.warnings;
        return;
      case FieldKind::conductor:
        return read_entry(place, result_.conductor);
      case FieldKind::insulation_material:
        return read_entry(place, result_.insulation);
      case FieldKind::motor_points:
        return;  // no spec has them but in a motor
    }
  }

  void estimate_drag(std::span<const SpecField> fields, const std::vector<JsonPlace>& places) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (may_be_left_out(fields[i]) && places[i].given()) return;
    }
    result_.design.drone.drag = drag_of_mass(result_.design.drone.mass);
  }

  template <typename Entry>
  void read_entry(const JsonPlace& place, Entry& taken) {
    std::optional<Entry> entry = entry_at<Entry>(place, result_.load, problems_);
    if (!entry) return;
    put_entry(result_.design, *entry);
    taken = std::move(*entry);
  }

  const JsonDocument& document_;
  DesignFile& result_;
  Problems& problems_;
};

DesignFile design_of(JsonDocument document, const TextLoader& load,
                     std::span<const std::string> overrides) {
  Problems problems;
  problems.add(document.problems);
  for (const std::string& text : overrides) apply_override(document, text, problems);
  DesignFile result;
  result.name = as_utf8(file_stem(document.name));
  result.file = document.name;
  result.load = load;
  SpecReader(document, result, problems).read();
  problems.throw_if_any();
  result.document = std::move(document.root);
  return result;
}

}  // namespace

DesignFile parse_design(std::string_view text, const std::string& file, const TextLoader& load,
                        std::span<const std::string> overrides) {
  return design_of(parse_json(text, file), load, overrides);
}

DesignFile read_design_document(nlohmann::ordered_json document, const std::string& file,
                                const TextLoader& load) {
  return design_of({file, std::move(document), {}, {}, {}}, load, {});
}

std::string starting_spec() { return std::string(embedded_file("starting_spec.json")); }

}  // namespace tethercalc
