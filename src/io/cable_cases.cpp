#include "tethercalc/io/cable_cases.hpp"

#include <array>

#include "io/checked_values.hpp"

namespace tethercalc {
namespace {

constexpr FieldRange positive{.min = 0, .max = 1e12, .min_excluded = true};
constexpr FieldRange not_negative{.min = 0, .max = 1e12};
constexpr FieldRange any_length{.min = -1e12, .max = 1e12};

constexpr SpecField field(std::string_view pointer, const FieldRange& range, std::string_view unit,
                          std::string_view help) {
  SpecField described;
  described.pointer = pointer;
  described.range = range;
  described.unit = unit;
  described.help = help;
  return described;
}

constexpr SpecField stiffness_field() {
  SpecField described =
      field("/EA_N", positive, "N", "Axial stiffness; null: it does not stretch.");
  described.kind = FieldKind::optional_number;
  described.default_json = "null";
  return described;
}

constexpr SpecField vector_field(std::string_view pointer, std::string_view help) {
  SpecField described = field(pointer, {}, "", help);
  described.kind = FieldKind::motor_points;  // a list
  return described;
}

constexpr std::array plane_fields{
    field("/L_m", positive, "m", "Length without tension."),
    field("/w_N_per_m", positive, "N/m", "Weight."),
    stiffness_field(),
    field("/x_m", not_negative, "m", "The drone's distance aside."),
    field("/z_m", any_length, "m", "The drone's height."),
};

constexpr std::array space_fields{
    field("/L_m", positive, "m", "Length without tension."),
    field("/w_N_per_m", not_negative, "N/m", "Weight."),
    stiffness_field(),
    vector_field("/drone_m", "Place of the drone: x, y, z in m."),
    vector_field("/wind_m_s", "Velocity of the air: x, y, z in m/s."),
    field("/diameter_m", not_negative, "m", "Width that the wind meets."),
    field("/Cd", not_negative, "", "Drag coefficient."),
    field("/rho_kg_m3", not_negative, "kg/m³", "Density of the air."),
};

std::optional<Vector3> read_vector(const JsonPlace& place, Problems& problems) {
  if (!place.value->is_array() || place.value->size() != 3) {
    return problems.refuse(place.where(), "expected a list of three numbers");
  }
  std::array<double, 3> numbers{};
  constexpr SpecField component = field("", any_length, "", "");
  bool read = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = checked_number(place.element(i), component, problems);
    read = read && number;
    numbers[i] = number.value_or(0);
  }
  if (!read) return std::nullopt;
  return Vector3{numbers[0], numbers[1], numbers[2]};
}

std::optional<CableCase> read_case(const JsonPlace& object, Problems& problems) {
  const std::size_t before = problems.count();
  if (!object.value->is_object() || !object.value->contains("input") ||
      !object.value->contains("id")) {
    return problems.refuse(object.where(), R"(expected an object with "id" and "input")");
  }
  CableCase out;
  out.id = checked_text(
      {object.document, &(*object.value)["id"], child_pointer(object.pointer, "id")}, problems);
  const JsonPlace input{object.document, &(*object.value)["input"],
                        child_pointer(object.pointer, "input")};
  out.in_plane = input.value->is_object() && input.value->contains("x_m");
  const std::span<const SpecField> fields =
      out.in_plane ? std::span<const SpecField>(plane_fields) : space_fields;
  const std::vector<JsonPlace> at = field_places(input, fields, problems);
  if (problems.count() > before) return std::nullopt;
  const auto number = [&](std::size_t k) { return checked_number(at[k], fields[k], problems); };
  const auto length = number(0);
  const auto weight = number(1);
  out.cable.axial_stiffness = number(2);
  out.length = length.value_or(1);
  out.cable.weight = weight.value_or(1);
  if (out.in_plane) {
    out.drone = {number(3).value_or(0), 0, number(4).value_or(1)};
  } else {
    out.drone = read_vector(at[3], problems).value_or(Vector3{});
    out.air.wind = read_vector(at[4], problems).value_or(Vector3{});
    out.cable.diameter = number(5).value_or(0);
    out.cable.drag_coefficient = number(6).value_or(0);
    out.air.density = number(7).value_or(0);
  }
  if (problems.count() > before) return std::nullopt;
  if (out.drone == Vector3{}) return problems.refuse(input.where(), "the drone is at the anchor");
  return out;
}

}  // namespace

std::vector<CableCase> parse_cable_cases(std::string_view text, std::string name) {
  const JsonDocument document = parse_json(text, std::move(name));
  Problems problems;
  problems.add(document.problems);
  std::vector<CableCase> cases;
  if (!document.root.is_object() || !document.root.contains("cases") ||
      !document.root["cases"].is_array()) {
    problems.add(document.where(""), R"(expected an object with a list "cases")");
  } else {
    const JsonPlace list{&document, &document.root["cases"], "/cases"};
    for (std::size_t i = 0; i < list.value->size(); ++i) {
      if (auto one = read_case(list.element(i), problems)) cases.push_back(std::move(*one));
    }
  }
  problems.throw_if_any();
  return cases;
}

}  // namespace tethercalc
