// What is read from a spec, changed and written is what a reader finds again: for every field of
// the table, alone and with all others.
#include "tethercalc/io/spec_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/design_numbers.hpp"
#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "support/run_program.hpp"
#include "tethercalc/io/spec_fields.hpp"

using namespace tethercalc;
using test::each_random;
using test::numbers_of;
using test::Random;
using Json = nlohmann::ordered_json;

namespace {

double random_number(Random& random, const SpecField& field) {
  const FieldRange& range = field.range;
  const double lo = std::max(range.min, -1000.0);
  const double hi = std::min(range.max, 1000.0);
  double value = random.uniform(lo, hi);
  if (random.chance(0.5)) value = std::strtod(fmt::format("{:.3g}", value).c_str(), nullptr);
  if (field.kind == FieldKind::integer) value = std::floor(value);
  return range.contains(value) ? value : random.uniform(lo, hi);
}

/// A motor, as a reader of its points in practical units would have it.
MotorCurve motor_as_read(const MotorCurve& curve) {
  std::vector<MotorPoint> points;
  for (const MotorPoint& p : curve.vertices().subspan(1)) {
    points.push_back({p.thrust / unit::gram_force * unit::gram_force, p.power});
  }
  return MotorCurve(points);
}

void set_off_neutral(Random& random, const SpecField& field, Design& design) {
  Converter& converter = design.supply.converter;
  const auto numbers = [&](std::span<const SpecField> fields) {
    for (const SpecField& part : fields) {
      if (is_numeric(part)) set_field(design, part, random_number(random, part));
    }
  };
  switch (field.kind) {
    case FieldKind::motor:
      design.drone.motor = motor_as_read(test::random_motor(random, 0.5));
      return;
    case FieldKind::conductor:
      return numbers(object_fields(FieldKind::conductor));
    case FieldKind::insulation_material:
      return numbers(object_fields(FieldKind::insulation_material));
    case FieldKind::converter_masses: {
      const double mass = random.integer(1, 500) * unit::gram;
      converter.masses = {{random.uniform(1, 400), mass}, {random.uniform(401, 900), 2 * mass}};
      return;
    }
    case FieldKind::efficiency:
      converter.efficiency = test::random_converter(random, design.supply.voltage).efficiency;
      return;
    case FieldKind::boolean:
    case FieldKind::condition:
    case FieldKind::strength_material:
    case FieldKind::tether_model:
    case FieldKind::wind_profile:
      return set_word(design, field, 1 - std::min<std::size_t>(field_word(design, field), 1));
    default:
      if (is_numeric(field)) set_field(design, field, random_number(random, field));
  }
}

/// Takes back what does not go together with the rest.
void settle(Design& design, const Design& base) {
  while (true) {
    const auto conflicts = find_conflicts(design);
    if (conflicts.empty()) return;
    design.supply.voltage = base.supply.voltage;
    design.supply.converter = base.supply.converter;
    design.tether.insulation.dielectric_safety_factor = 0;
    design.tether.drag_by_reynolds_number = base.tether.drag_by_reynolds_number;
    design.flight.horizontal_offset = base.flight.horizontal_offset;
    design.flight.roughness_length = base.flight.roughness_length;
    for (const FieldConflict& conflict : conflicts) {
      if (conflict.pointer.starts_with("/tether/drum/")) design.tether.drum = base.tether.drum;
    }
  }
}

DesignFile inline_spec() {
  Json spec = Json::parse(starting_spec());
  spec["tether"]["conductor"] = {{"id", "mine"},
                                 {"name", "Mine"},
                                 {"resistivity_20C_ohm_mm2_per_m", 0.02},
                                 {"temperature_coefficient_per_K", 0.004},
                                 {"density_g_cm3", 5},
                                 {"tensile_strength_MPa", 100}};
  spec["notes"] = "mine";
  return parse_design(spec.dump(), "inline.json");
}

void check_returns(const DesignFile& file, const Design& design) {
  const Json written = spec_with(file, design);
  INFO(written.dump(1));
  CHECK(numbers_of(parse_design(written.dump(), "written.json").design) == numbers_of(design));
}

}  // namespace

TEST_CASE("an unchanged design is written as it was read, whatever its spelling") {
  for (const DesignFile& file : {parse_design(starting_spec(), "start.json"), inline_spec()}) {
    CHECK(spec_with(file, file.design).dump() == file.document.dump());
  }
}

TEST_CASE("each field off neutral is written, read again as it was, and changes nothing else") {
  const DesignFile files[] = {parse_design(starting_spec(), "start.json"), inline_spec()};
  each_random(test::draws(10), [&](Random& random) {
    const DesignFile& file = files[random.integer(0, 1)];
    for (const SpecField& field : spec_fields()) {
      INFO(field.pointer);
      Design design = file.design;
      set_off_neutral(random, field, design);
      settle(design, file.design);
      check_returns(file, design);
      Json written = spec_with(file, design);
      Json before = file.document;
      const Json::json_pointer pointer{std::string(field.pointer)};
      if (!written.contains(pointer)) continue;
      before[pointer] = written[pointer];
      CHECK(written == before);
    }
  });
}

TEST_CASE("all fields off neutral at once are written and read again as they were") {
  const DesignFile files[] = {parse_design(starting_spec(), "start.json"), inline_spec()};
  each_random(test::draws(200), [&](Random& random) {
    const DesignFile& file = files[random.integer(0, 1)];
    Design design = file.design;
    for (const SpecField& field : spec_fields()) set_off_neutral(random, field, design);
    settle(design, file.design);
    check_returns(file, design);
  });
}

TEST_CASE("motors and materials of the library are written by name") {
  const DesignFile file = inline_spec();
  Design design = file.design;
  put_entry(design, find_conductor("copper"));
  put_entry(design, find_motor("tmotor-mn4014-400kv-15in"));
  const Json written = spec_with(file, design);
  CHECK(written["tether"]["conductor"] == "copper");
  CHECK(written["drone"]["motor"] == "tmotor-mn4014-400kv-15in");
}

TEST_CASE("one number of an own material is written into its object, which stays otherwise") {
  const DesignFile file = inline_spec();
  Design design = file.design;
  design.tether.conductor.density = 6000;
  Json expected = file.document;
  expected["tether"]["conductor"]["density_g_cm3"] = 6.0;
  CHECK(spec_with(file, design) == expected);
  design.tether.conductor.tensile_strength = 0;  // unknown
  expected["tether"]["conductor"].erase("tensile_strength_MPa");
  CHECK(spec_with(file, design) == expected);
}

TEST_CASE("numbers are written with the digits that people would write") {
  const DesignFile file = parse_design(starting_spec(), "start.json");
  Design design = file.design;
  design.drone.mass = 300 * unit::gram;
  design.tether.cross_section = 1.5 * unit::square_millimetre;
  const std::string written = spec_with(file, design).dump();
  CHECK_THAT(written,
             Catch::Contains("\"cross_section_mm2\":1.5") && Catch::Contains("\"mass_g\":300.0"));
}

TEST_CASE("an estimated drag is in no spec, and what takes its place is written whole") {
  Json spec = Json::parse(starting_spec());
  spec["drone"].erase("drag");
  const DesignFile file = parse_design(spec.dump(), "no-drag.json");
  CHECK(file.design.drone.drag.is_estimate);
  CHECK(file.design.drone.drag.front_area > 0);
  Design design = file.design;
  design.tether.length = 12;
  CHECK_FALSE(spec_with(file, design)["drone"].contains("drag"));
  // Were only the area written, the linear part of the drag would be lost.
  design.drone.drag.front_area *= 1.5;
  const DesignFile written = parse_design(spec_with(file, design).dump(), "written.json");
  CHECK_FALSE(written.design.drone.drag.is_estimate);
  CHECK(numbers_of(written.design) == numbers_of(design));
}

TEST_CASE("half a drag is no reason to estimate the rest") {
  Json spec = Json::parse(starting_spec());
  spec["drone"]["drag"] = Json{{"front_area_m2", 0.01}};
  CHECK_THROWS_WITH(parse_design(spec.dump(), "half.json"),
                    Catch::Contains("\"top_area_m2\" is missing"));
}
