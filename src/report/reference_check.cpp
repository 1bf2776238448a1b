#include "tethercalc/report/reference_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/json_document.hpp"
#include "report/characters.hpp"
#include "report/result_values.hpp"

namespace tethercalc {
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

/// Number, text or null as people read it.
std::string value_words(const ResultValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return value.index() == 0 ? "none" : json_line(result_json(value));
}

std::string drift_words(const RecordedResult& result) {
  if (!result.difference) return "";
  const double recorded = std::get<double>(result.recorded);
  std::string words = fmt::format("{:+.3g}", *result.difference);
  if (recorded != 0) words += fmt::format(" ({:+.3g} %)", 100 * *result.difference / recorded);
  return words + fmt::format(", allowed ±{:.3g}", result.tolerance);
}

/// What is wrong with a design that did not pass: its problems or, where there are none, what
/// drifted.
std::vector<std::string> complaints(const ReferenceCheck& check) {
  std::vector<std::string> lines;
  for (const InputProblem& problem : check.problems) {
    lines.push_back(problem.where + ": " + problem.message);
  }
  if (!lines.empty()) return lines;
  if (!check.recorded) return {"no record; --update makes one"};
  for (const RecordedResult& result : check.results) {
    if (!result.drifted) continue;
    const std::string words = drift_words(result);
    lines.push_back(fmt::format("{}: recorded {}, now {}{}{}", result.name,
                                value_words(result.recorded), value_words(result.computed),
                                words.empty() ? "" : ": ", words));
  }
  return lines;
}

constexpr std::array<std::string_view, 4> status_names{"ok", "drifted", "unrecorded", "error"};

std::string_view status_of(const ReferenceCheck& check) {
  return !check.problems.empty() ? status_names[3]
         : !check.recorded       ? status_names[2]
         : check.passed()        ? status_names[0]
                                 : status_names[1];
}

/// In an attribute, where XML readers would make spaces of line breaks.
std::string attribute_text(std::string_view text) {
  std::string out;
  for (const char c : markup_text(text))
    out += c == '\n' ? std::string("&#10;") : std::string(1, c);
  return out;
}

std::size_t count_status(std::span<const ReferenceCheck> checks, std::string_view status) {
  return static_cast<std::size_t>(std::ranges::count(checks, status, status_of));
}

}  // namespace

std::span<const std::string_view> check_status_names() { return status_names; }

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

std::string check_text(std::span<const ReferenceCheck> checks, bool updated,
                       const TextStyle& style) {
  std::string out;
  for (const ReferenceCheck& check : checks) {
    const std::string status(status_of(check));
    const std::string shown_status = check.passed() ? style.good(status) : style.bad(status);
    out += fmt::format("{}{}  {}  {}\n", shown_status, std::string(10 - status.size(), ' '),
                       printable(check.spec), style.subdued(printable(check.name)));
    if (check.passed()) continue;
    for (const std::string& complaint : complaints(check)) {
      out += "    " + printable(complaint) + "\n";
    }
  }
  out += fmt::format("{} designs: {} as recorded, {} drifted, {} without a record", checks.size(),
                     count_status(checks, "ok"), count_status(checks, "drifted"),
                     count_status(checks, "unrecorded"));
  return out + (updated ? "; records brought up to date\n" : "\n");
}

ordered_json check_json(std::span<const ReferenceCheck> checks) {
  const auto entry_json = [](const RecordedResult& result) {
    return ordered_json{{"result", result.name},
                        {"recorded", result_json(result.recorded)},
                        {"computed", result_json(result.computed)},
                        {"difference", number_or_null(result.difference)},
                        {"tolerance", result.tolerance},
                        {"drifted", result.drifted}};
  };
  const ordered_json designs = json_list(checks, [&](const ReferenceCheck& check) {
    return ordered_json{{"spec", check.spec},
                        {"name", check.name},
                        {"status", status_of(check)},
                        {"results", json_list(check.results, entry_json)}};
  });
  return {{"designs", designs},
          {"ok", count_status(checks, "ok")},
          {"drifted", count_status(checks, "drifted")},
          {"unrecorded", count_status(checks, "unrecorded")}};
}

std::string check_csv(std::span<const ReferenceCheck> checks) {
  std::string out = "spec,status,result,recorded,computed,difference,tolerance,drifted\n";
  const auto cell = [](const ResultValue& value) {
    return value.index() == 0 ? ordered_json(nullptr) : ordered_json(value_words(value));
  };
  for (const ReferenceCheck& check : checks) {
    for (const RecordedResult& result : check.results) {
      out += csv_line({check.spec, status_of(check), result.name, cell(result.recorded),
                       cell(result.computed), number_or_null(result.difference), result.tolerance,
                       result.drifted});
    }
  }
  return out;
}

std::string check_junit(std::span<const ReferenceCheck> checks) {
  const std::size_t errors = count_status(checks, "error");
  const std::size_t failures = checks.size() - errors - count_status(checks, "ok");
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", checks.size(), failures, errors);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out +=
      fmt::format("<testsuites {}>\n  <testsuite name=\"tethercalc check\" {}>\n", counts, counts);
  for (const ReferenceCheck& check : checks) {
    const std::size_t name = check.spec.rfind('/') + 1;
    const std::string opening =
        fmt::format("    <testcase classname=\"{}\" name=\"{}\"",
                    attribute_text(std::string_view(check.spec).substr(0, name > 0 ? name - 1 : 0)),
                    attribute_text(std::string_view(check.spec).substr(name)));
    if (check.passed()) {
      out += opening + "/>\n";
      continue;
    }
    out += fmt::format("{}>\n      <{} type=\"{}\" message=\"{}\"/>\n    </testcase>\n", opening,
                       check.problems.empty() ? "failure" : "error", status_of(check),
                       attribute_text(fmt::format("{}", fmt::join(complaints(check), "\n"))));
  }
  return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace tethercalc
