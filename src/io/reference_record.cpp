#include "tethercalc/io/reference_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/json_document.hpp"

namespace tethercalc {

using nlohmann::ordered_json;

namespace {

constexpr double default_relative_tolerance = 1e-6;

/// What a new record holds, as far as it exists.
constexpr const char* main_results[] = {"status",
                                        "limited_by",
                                        "limiting_condition",
                                        "cross_section_mm2",
                                        "hover.tether_mass_g",
                                        "hover.headroom",
                                        "hover.total_power_W",
                                        "hover.received_voltage_V",
                                        "forward.pitch_deg",
                                        "forward.headroom",
                                        "forward.total_power_W",
                                        "forward.received_voltage_V",
                                        "headroom.best",
                                        "minimum_power.cross_section_mm2",
                                        "minimum_power.total_power_W"};

/// What the record has; what is neither number nor text counts as nothing.
ResultValue value_of(const ordered_json& value) {
  if (value.is_number()) return value.get<double>();
  return value.is_string() ? ResultValue(value.get<std::string>()) : ResultValue();
}

constexpr const char* tolerances[] = {"relative_tolerance", "absolute_tolerance"};

bool has_tolerance(const ordered_json& entry) {
  return entry.contains(tolerances[0]) || entry.contains(tolerances[1]);
}

/// Compares one entry of a record.
std::optional<RecordedResult> compared(const JsonDocument& document, const NamedResult& computed,
                                       Problems& problems) {
  const std::string pointer = child_pointer("", computed.name);
  const ordered_json& entry = document.root[computed.name];
  if (!entry.is_object() || !entry.contains("value")) {
    return problems.refuse(document.where(pointer),
                           "expected an object with \"value\" and a tolerance");
  }
  const std::vector<std::string> known{"value", tolerances[0], tolerances[1]};
  for (const auto& [key, value] : entry.items()) {
    if (std::ranges::find(known, key) == known.end()) {
      problems.add(document.where(child_pointer(pointer, key)),
                   fmt::format("unknown key {}{}", shown(key), did_you_mean(key, known)));
    }
  }
  const auto tolerance = [&](const char* key) {
    if (!entry.contains(key)) return 0.0;
    const ordered_json& value = entry[key];
    if (value.is_number() && value.get<double>() >= 0) return value.get<double>();
    problems.add(document.where(child_pointer(pointer, key)),
                 "a tolerance is a number of at least 0, found " + shown(value));
    return 0.0;
  };
  const double relative = tolerance(tolerances[0]);
  const double absolute = tolerance(tolerances[1]);
  if (entry["value"].is_number() && !has_tolerance(entry)) {
    problems.add(document.where(pointer),
                 "a number needs \"relative_tolerance\" or \"absolute_tolerance\"");
  }
  return held_against({computed.name, value_of(entry["value"])}, computed.value, relative,
                      absolute);
}

std::vector<RecordedResult> compared(const JsonDocument& document,
                                     const std::vector<NamedResult>& results) {
  Problems problems;
  problems.add(document.problems);
  std::vector<RecordedResult> all;
  if (!document.root.is_object()) {
    problems.add(document.where(""), "a record is an object, found " + type_name(document.root));
    problems.throw_if_any();
  }
  std::vector<std::string> names;
  for (const NamedResult& result : results) names.push_back(result.name);
  for (const auto& [name, entry] : document.root.items()) {
    const auto known = std::ranges::find(names, name);
    if (known == names.end()) {
      problems.add(document.where(child_pointer("", name)),
                   fmt::format("no result {}{}", shown(name), did_you_mean(name, names)));
    } else if (auto result =
                   compared(document, results[std::size_t(known - names.begin())], problems)) {
      all.push_back(std::move(*result));
    }
  }
  problems.throw_if_any();
  return all;
}

std::vector<RecordedResult> unrecorded(const std::vector<NamedResult>& results) {
  std::vector<RecordedResult> all;
  for (const char* name : main_results) {
    for (const auto& [known, value] : results) {
      const bool exists = known == name && value.index() != 0;
      if (exists) all.push_back({name, {}, value, 0, std::nullopt, true});
    }
  }
  return all;
}

}  // namespace

bool ReferenceCheck::passed() const {
  return recorded && problems.empty() && std::ranges::none_of(results, &RecordedResult::drifted);
}

ReferenceCheck check_reference(std::string spec, const DesignFile& file,
                               const std::vector<NamedResult>& results,
                               const std::optional<LoadedText>& record) {
  ReferenceCheck check;
  check.spec = std::move(spec);
  check.name = file.name;
  check.recorded = record.has_value();
  try {
    check.results =
        record ? compared(parse_json(record->text, record->name), results) : unrecorded(results);
  } catch (const InputError& error) {
    check.problems = error.problems();
  }
  return check;
}

std::string updated_record(const ReferenceCheck& check, const std::optional<LoadedText>& old) {
  ordered_json record = old ? json_of(old->text) : ordered_json::object();
  for (const RecordedResult& result : check.results) {
    if (!result.drifted) continue;
    ordered_json& entry = record[result.name];
    entry["value"] = result_json(result.computed);
    const bool number = std::holds_alternative<double>(result.computed);
    if (number && !has_tolerance(entry)) entry[tolerances[0]] = default_relative_tolerance;
  }
  return json_text(record);
}

}  // namespace tethercalc
