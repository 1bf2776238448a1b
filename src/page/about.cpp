#include <array>
#include <cmath>

#include "io/embedded_files.hpp"
#include "io/json_document.hpp"
#include "page/asks.hpp"
#include "page/example_specs.hpp"
#include "report/result_values.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/explanation.hpp"

namespace tethercalc::page {
namespace {

std::string_view kind_name(FieldKind kind) {
  switch (kind) {
    case FieldKind::number:
    case FieldKind::optional_number:
      return "number";
    case FieldKind::integer:
      return "integer";
    case FieldKind::boolean:
      return "flag";
    case FieldKind::text:
      return "text";
    case FieldKind::condition:
    case FieldKind::strength_material:
    case FieldKind::tether_model:
    case FieldKind::wind_profile:
      return "choice";
    case FieldKind::motor:
      return "motor";
    case FieldKind::conductor:
      return "conductor";
    case FieldKind::insulation_material:
      return "insulation";
    case FieldKind::efficiency:
      return "efficiency";
    case FieldKind::converter_masses:
      return "converter_masses";
    case FieldKind::motor_points:
      return "motor_points";
  }
  return "text";
}

/// `starting`: the spec for beginners, whose fields come first.
ordered_json field_json(const SpecField& field, const ordered_json& starting) {
  const ordered_json::json_pointer pointer{std::string(field.pointer)};
  return {{"path", dot_path(field.pointer)},
          {"pointer", field.pointer},
          {"unit", field.unit},
          {"kind", kind_name(field.kind)},
          {"least", number_or_null(field.range.min)},
          {"greatest", number_or_null(field.range.max)},
          {"open ends", {field.range.min_excluded, field.range.max_excluded}},
          {"required", field.required() && !may_be_left_out(field)},
          {"optional", field.kind == FieldKind::optional_number},
          {"default", field.required() ? ordered_json(nullptr) : json_of(field.default_json)},
          {"choices", json_list(field.kind == FieldKind::boolean ? std::span<const std::string>()
                                                                 : field_words(field.kind),
                                [](const std::string& word) { return word; })},
          {"help", field.help},
          {"common", starting.contains(pointer)},
          {"fields", json_list(object_fields(field.kind), [](const SpecField& inner) {
             return field_json(inner, ordered_json::object());
           })}};
}

ordered_json points_json(const MotorCurve& curve) {
  ordered_json points = ordered_json::array();
  for (const auto& vertex : curve.vertices()) {
    if (vertex.thrust > 0) points.push_back({vertex.thrust / unit::gram_force, vertex.power});
  }
  return points;
}

ordered_json motors_json() {
  return json_list(library_motors(), [](const MotorEntry& motor) {
    return ordered_json{{"id", motor.id},
                        {"name", motor.name},
                        {"max_thrust_g", motor.curve.max_thrust() / unit::gram_force},
                        {"voltage_V", number_or_null(motor.voltage_V)},
                        {"propeller_in", number_or_null(motor.propeller_in)},
                        {"points", points_json(motor.curve)},
                        {"source", motor.source}};
  });
}

/// What `list` says of each, with the name that people use.
template <typename Entry>
ordered_json materials_json(const std::string& what, const std::vector<Entry>& entries) {
  ordered_json out = library_json(what);
  for (std::size_t i = 0; i < out.size(); ++i) out[i]["name"] = entries.at(i).name;
  return out;
}

ordered_json examples_json() {
  return json_list(example_specs(), [](const EmbeddedFile& file) {
    return ordered_json{{"name", file_stem(file.name)},
                        {"title", json_of(file.content).value("name", "")},
                        {"spec", file.content}};
  });
}

std::span<const std::string> strength_materials() {
  return field_words(FieldKind::strength_material);
}

}  // namespace

ordered_json about(const Request&) {
  const ordered_json starting = json_of(starting_spec());
  return {
      {"version", TETHERCALC_VERSION},
      {"fields", json_list(spec_fields(),
                           [&](const SpecField& field) { return field_json(field, starting); })},
      {"motors", motors_json()},
      {"conductors", materials_json("conductors", library_conductors())},
      {"insulations", materials_json("insulation", library_insulation())},
      {"sizes", library_json("sizes")},
      {"strength materials",
       json_list(strength_materials(), [](const std::string& word) { return word; })},
      {"starting spec", starting_spec()},
      {"examples", examples_json()}};
}

ordered_json explain(const Request& request) {
  const Explanation& page = explanation_of(request.text("code"));
  return {{"text", explanation_text(page, {})}, {"result", explanation_json(page)}};
}

}  // namespace tethercalc::page
