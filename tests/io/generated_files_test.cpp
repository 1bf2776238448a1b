// The files that are made from the table of fields and committed for people who read them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>

#include "tethercalc/io/spec_fields.hpp"

using namespace tethercalc;

namespace {

std::string allowed(const SpecField& field) {
  const auto words = field_words(field.kind);
  switch (field.kind) {
    case FieldKind::boolean:
      return "`true` or `false`";
    case FieldKind::condition:
    case FieldKind::strength_material:
    case FieldKind::tether_model:
    case FieldKind::wind_profile:
      return fmt::format("`\"{}\"` or `\"{}\"`",
                         fmt::join(words.begin(), words.end() - 1, "\"`, `\""), words.back());
    case FieldKind::text:
      return "text";
    case FieldKind::motor:
      return "name, `.json` or `.csv` file, [motor](#motor)";
    case FieldKind::conductor:
      return "name, `.json` file, [conductor](#conductor)";
    case FieldKind::insulation_material:
      return "name, `.json` file, [material](#insulation-material)";
    case FieldKind::converter_masses:
      return "list of [rows](#row-of-a-converters-table-of-masses)";
    case FieldKind::efficiency:
      return describe_range(field) + ", or list of [points](#point-of-an-efficiency-curve)";
    case FieldKind::motor_points:
      return "list of [points](#point-of-a-motor-curve)";
    case FieldKind::integer:
      return "whole number, " + describe_range(field);
    default:
      return describe_range(field);
  }
}

std::string default_of(const SpecField& field) {
  if (field.required() && may_be_left_out(field)) {
    return "**required** in `drone.drag`; without that, [estimated](drag.md#without-a-flight)";
  }
  if (field.required()) return "**required**";
  if (field.default_json == "null" || field.default_json == "\"\"") return "none";
  return fmt::format("`{}`", field.default_json);
}

constexpr std::string_view table_head =
    "| field | allowed | default | meaning |\n|---|---|---|---|\n";

std::string row(const SpecField& field, std::string_view key) {
  return fmt::format("| `{}` | {} | {} | {} |\n", key, allowed(field), default_of(field),
                     field.help);
}

std::string object_section(std::string_view title, std::span<const SpecField> fields) {
  std::string text = fmt::format("\n## {}\n\n{}", title, table_head);
  for (const SpecField& field : fields) text += row(field, field.pointer.substr(1));
  return text;
}

constexpr std::string_view introduction = R"(# The design spec

A design spec is a JSON file (UTF-8, at most 1 MiB) that describes a tethered drone. `tethercalc
init` writes one to start from, `tethercalc validate` checks one, and `tethercalc schema` prints a
JSON Schema with which editors check and complete it.

A dot in the name of a field stands for an object in an object: `supply.voltage_V` is the key
`voltage_V` in the object `supply`. The same names serve `--set supply.voltage_V=60` on the command
line. Units are part of the names; grams of thrust are gram-force of 9.80665 mN, as motor data
sheets print them. Unknown keys, wrong types and numbers out of range are errors. Upper ends of
ranges stand well beyond anything that flies: they catch slips of the unit.

Motor, conductor and insulation material are each one of
- a name in the library (`tethercalc list motors`, `conductors`, `insulation`);
- the path of a file, relative to the spec: it holds a `/` or ends in `.json` or `.csv`;
- an object with the fields given below.

The points of a motor, from whatever source, are sorted by thrust, and neighbours whose power does
not rise with thrust are pooled to their mean (isotonic regression); a warning names them. A
test-bench CSV is read as [motors.md](motors.md) says: thrust and power, or what power is made of, in
columns whose header names their units; rows whose thrust or power is not above 0 are left
out with a warning.
)";

/// The reference of all fields as Markdown: the content of docs/spec.md.
std::string spec_reference() {
  std::string text(introduction);
  text += "\n## Fields\n\n";
  text += table_head;
  for (const SpecField& field : spec_fields()) text += row(field, dot_path(field.pointer));
  text += "\nThe converter must cut off below the supply voltage.\n";
  text += object_section("Motor", object_fields(FieldKind::motor));
  text += object_section("Point of a motor curve", object_fields(FieldKind::motor_points));
  text += "\nEach point has exactly one of `efficiency_g_per_W` and `power_W`.\n";
  text += object_section("Conductor", object_fields(FieldKind::conductor));
  text += object_section("Insulation material", object_fields(FieldKind::insulation_material));
  text += object_section("Point of an efficiency curve", object_fields(FieldKind::efficiency));
  text +=
      "\nThe points stand by rising `output_W`; efficiency is linear between them and constant\n"
      "outside. The power drawn must rise with the output.\n";
  text += object_section("Row of a converter's table of masses",
                         object_fields(FieldKind::converter_masses));
  text +=
      "\nThe rows stand by rising `rated_output_W`; mass is linear between them, that of the "
      "first\n"
      "below it, and that of the last in proportion above it.\n";
  return text;
}

/// With TETHERCALC_UPDATE set in the environment the file is written instead.
void check_is_current(const std::string& name, const std::string& expected) {
  const auto path = std::filesystem::path(TETHERCALC_SOURCE_DIR) / name;
  if (std::getenv("TETHERCALC_UPDATE") != nullptr) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << expected;
  }
  std::ostringstream committed;
  committed << std::ifstream(path).rdbuf();
  INFO(name << " is out of date; run this test with TETHERCALC_UPDATE=1 and commit the file");
  CHECK(committed.str() == expected);
}

}  // namespace

TEST_CASE("the committed schema is the one that the fields give") {
  check_is_current("data/schema/design.schema.json", spec_schema().dump(2) + "\n");
}

TEST_CASE("the committed reference is the one that the fields give") {
  check_is_current("docs/spec.md", spec_reference());
}
