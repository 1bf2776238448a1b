#include "report/result_values.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

std::string conductor_words(const ConductorEntry& conductor) {
  if (!conductor.id.empty()) return conductor.id;
  return conductor.name.empty() ? "the spec's own conductor" : conductor.name;
}

std::optional<double> power_uncertainty_percent(const Design& design) {
  const std::optional<double> share = design.drone.motor.uncertainty();
  return share ? std::optional(100 * *share) : std::nullopt;
}

std::optional<double> drag_uncertainty_factor(const Design& design) {
  return design.drone.drag.is_estimate ? std::optional(drag_estimate_factor) : std::nullopt;
}

std::array<std::pair<const char*, std::optional<double>>, 2> estimates_of(const Design& design) {
  return {{{"power_uncertainty_percent", power_uncertainty_percent(design)},
           {"drag_uncertainty_factor", drag_uncertainty_factor(design)}}};
}

void add_estimates(ordered_json& answer, const Design& design) {
  for (const auto& [name, value] : estimates_of(design)) answer[name] = number_or_null(value);
}

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : ordered_json(nullptr);
}

ordered_json operating_point_json(const OperatingPoint& point) {
  ordered_json out = ordered_json::object();
  for (const OperatingPointField& field : operating_point_fields()) {
    out[std::string(field.key)] = number_or_null(practical_value(point, field));
  }
  return out;
}

namespace {

void add_told(ordered_json& answer, const char* sentences, const char* codes,
              std::span<const Warning> told) {
  answer[sentences] = json_list(told, [](const Warning& w) { return w.sentence; });
  answer[codes] = json_list(told, [](const Warning& w) { return warning_code(w.kind); });
}

}  // namespace

void add_warnings(ordered_json& answer, std::span<const Warning> warnings) {
  add_told(answer, "warnings", "warning_codes", warnings);
}

void add_notes(ordered_json& answer, std::span<const Warning> notes) {
  add_told(answer, "notes", "note_codes", notes);
}

std::string strength_words(double load, double tension, std::string_view of_what) {
  if (!(load > 0)) {
    return "breaks at a load that is unknown: the conductor's tensile strength is not set";
  }
  const std::string times =
      tension > 0 ? fmt::format(", {} times {}", significant(load / tension, 3), of_what) : "";
  return fmt::format("breaks at {} N{}", significant(load, 3), times);
}

std::string with_stop(std::string sentence) {
  if (!sentence.ends_with('.')) sentence += '.';
  return sentence;
}

std::string csv_text(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string csv_line(const ordered_json& values) {
  std::string out;
  for (const ordered_json& value : values) {
    out += value.is_string()    ? csv_text(value.get_ref<const std::string&>())
           : value.is_number()  ? csv_number(value.get<double>())
           : value.is_boolean() ? value.get<bool>() ? "true" : "false"
                                : "";
    out += ',';
  }
  out.back() = '\n';
  return out;
}

}  // namespace tethercalc
