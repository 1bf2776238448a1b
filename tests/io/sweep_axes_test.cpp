#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "support/random_designs.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/sweep_axes.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

const DesignFile& base() {
  static const DesignFile file = parse_design(starting_spec(), "starting spec");
  return file;
}

SweepAxis axis_of(const std::string& text, bool sampled = false) {
  const std::vector<std::string> varied{text};
  auto axes = read_axes(varied, base(), sampled ? AxisUse::sampled : AxisUse::enumerated);
  REQUIRE(axes.size() == 1);
  return std::move(axes.front());
}

std::vector<double> values_of(const std::string& text) {
  const SweepAxis axis = axis_of(text);
  std::vector<double> values;
  for (std::uint64_t i = 0; i < value_count(axis).value(); ++i) {
    values.push_back(value_at(axis, i));
  }
  return values;
}

std::string refusal_of(const std::string& text, bool sampled = false) {
  const std::vector<std::string> varied{text};
  try {
    (void)read_axes(varied, base(), sampled ? AxisUse::sampled : AxisUse::enumerated);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

}  // namespace

TEST_CASE("ranges hold the decimal numbers between their ends") {
  using Values = std::vector<double>;
  CHECK(values_of("supply.voltage_V=40:100:30") == Values{40, 70, 100});
  CHECK(values_of("supply.voltage_V=40:99:30") == Values{40, 70});
  CHECK(values_of("supply.voltage_V=60:59:-0.5") == Values{60, 59.5, 59});
  CHECK(values_of("supply.voltage_V=60:60:1") == Values{60});
  CHECK(values_of("flight.headwind_m_s=-0.2:0.2:0.1") == Values{-0.2, -0.1, 0, 0.1, 0.2});
  CHECK(values_of("tether.contact_resistance_ohm=1e-3:5e-3:2E-3") == Values{0.001, 0.003, 0.005});
  CHECK(values_of("supply.voltage_V=1e2:3e+2:100") == Values{100, 200, 300});
  CHECK(values_of("drone.motor_count=4:8:2") == Values{4, 6, 8});
  CHECK(values_of("flight.headwind_m_s=0.30,-1,2e0") == Values{0.3, -1, 2});
  // A million steps on, the last one is still the number one would write.
  CHECK(values_of("tether.length_m=10:110:0.0001").back() == 110);
  CHECK(values_of("tether.length_m=10:110:0.0001")[333333] == 43.3333);
}

TEST_CASE("what cannot be stepped through is refused with the reason") {
  CHECK_THAT(refusal_of("supply.voltage_V=40:100:0"), Contains("do not lead"));
  CHECK_THAT(refusal_of("supply.voltage_V=40:100:-5"), Contains("do not lead"));
  CHECK_THAT(refusal_of("supply.voltage_V=40:100"), Contains("from:to:step"));
  CHECK_THAT(refusal_of("supply.voltage_V=40:1oo:5"), Contains("\"1oo\" is not a number"));
  CHECK_THAT(refusal_of("supply.voltage_V=40:inf:5"), Contains("not a number"));
  CHECK_THAT(refusal_of("supply.voltage_V=40,,60"), Contains("is not a number"));
  CHECK_THAT(refusal_of("supply.voltage_V=1:2:0.12345678901234567890"), Contains("more digits"));
  CHECK_THAT(refusal_of("supply.voltage_V=1:2:1e-300"), Contains("more digits"));
  CHECK_THAT(refusal_of("drone.motor_count=4:6:0.5"), Contains("whole number"));
  CHECK_THAT(refusal_of("drone.motor_count=2:80:2"), Contains("at most 64"));
  CHECK_THAT(refusal_of("supply.voltage_V"), Contains("path=values"));
  CHECK_THAT(refusal_of("supply.voltage_V="), Contains("no values"));
}

TEST_CASE("distributions are read for samples only") {
  CHECK(std::get<Uniform>(axis_of("tether.length_m=10..60.5", true).values).hi == 60.5);
  CHECK(std::get<Uniform>(axis_of("flight.headwind_m_s=-5..-1", true).values).lo == -5);
  CHECK(std::get<UniformInteger>(axis_of("drone.motor_count=4..8", true).values).hi == 8);
  const SweepAxis axis = axis_of("flight.headwind_m_s=-1~.5", true);
  CHECK(std::get<Normal>(axis.values).mean == -1);
  CHECK(std::get<Normal>(axis.values).standard_deviation == 0.5);
  CHECK_THAT(refusal_of("tether.length_m=10..60"), Contains("--sample"));
  CHECK_THAT(refusal_of("tether.length_m=10~1"), Contains("--sample"));
  CHECK_THAT(refusal_of("tether.length_m=60..10", true), Contains("must be below"));
  CHECK_THAT(refusal_of("tether.length_m=30~0", true), Contains("must be positive"));
  CHECK_THAT(refusal_of("tether.length_m=-3..10", true), Contains("at least 0.1"));
  CHECK_THAT(refusal_of("drone.motor_count=4~1", true), Contains("whole numbers"));
}

TEST_CASE("every field of a spec that changes the result can vary") {
  Design design = base().design;
  for (const SpecField& field : spec_fields()) {
    const std::string path = dot_path(field.pointer);
    INFO(path);
    switch (field.kind) {
      case FieldKind::text:
        CHECK_THAT(refusal_of(path + "=a"), Contains("does not change the result"));
        break;
      case FieldKind::boolean:
        CHECK(value_count(axis_of(path + "=true,false")) == 2U);
        CHECK_THAT(refusal_of(path + "=tru"), Contains("did you mean \"true\""));
        break;
      case FieldKind::tether_model:
        CHECK(value_count(axis_of(path + "=straight,solved")) == 2U);
        break;
      case FieldKind::wind_profile:
        CHECK(value_count(axis_of(path + "=uniform,power_law,logarithmic")) == 3U);
        CHECK(std::get<NamedChoices>(axis_of(path + "=power-law").values).names ==
              std::vector<std::string>{"power_law"});
        break;
      case FieldKind::strength_material:
        CHECK(value_count(axis_of(path + "=none,aramid,uhmwpe")) == 3U);
        CHECK_THAT(refusal_of(path + "=armid"), Contains(R"("none", "aramid" or "uhmwpe")") &&
                                                    Contains("did you mean \"aramid\""));
        break;
      case FieldKind::converter_masses:
        CHECK_THAT(refusal_of(path + "=1"), Contains("a sweep cannot vary this field"));
        break;
      case FieldKind::condition:
        CHECK(value_count(axis_of(path + "=hover,forward")) == 2U);
        break;
      case FieldKind::motor:
        CHECK(value_count(axis_of(path + "=all")) == library_motors().size());
        break;
      case FieldKind::conductor:
        CHECK(value_count(axis_of(path + "=all")) == library_conductors().size());
        break;
      case FieldKind::insulation_material:
        CHECK(value_count(axis_of(path + "=all")) == library_insulation().size());
        break;
      default: {
        const double value = field.range.contains(1)     ? 1
                             : field.range.contains(0.5) ? 0.5
                                                         : field.range.min;
        const SweepAxis axis = axis_of(path + "=" + std::to_string(value));
        axis.apply(design, value);
        CHECK(field_value(design, field).value() == Approx(value));
      }
    }
  }
}

TEST_CASE("numbers of a material vary whatever the material") {
  Design design = base().design;
  axis_of("tether.conductor.density_g_cm3=5").apply(design, 5);
  CHECK(design.tether.conductor.density == 5000);
  axis_of("tether.conductor.resistivity_20C_ohm_mm2_per_m=0.03").apply(design, 0.03);
  CHECK(design.tether.conductor.resistivity_20C == Approx(0.03e-6));
  axis_of("tether.insulation.material.density_g_cm3=2").apply(design, 2);
  CHECK(design.tether.insulation.density == 2000);
  CHECK_THAT(refusal_of("tether.conductor.density_g_cm3=-1"), Contains("at least"));
}

TEST_CASE("every pair of fields in conflict anywhere in a sweep is told at once") {
  DesignFile unknown = base();
  unknown.design.tether.insulation.breakdown_strength = 0;
  const std::vector<std::string> varied{"supply.voltage_V=75:10:-1",
                                        "tether.insulation.dielectric_safety_factor=0,3"};
  const SweepSpace space(read_axes(varied, unknown, AxisUse::enumerated));
  CHECK_NOTHROW(check_sweep_rows(SweepSpace({space.axes()[1]}), base()));
  try {
    check_sweep_rows(space, unknown);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Contains("supply gives only 20 V"));
    CHECK_THAT(error.what(), Contains("breakdown strength"));
    CHECK(error.problems().size() == 2);
  }
}

TEST_CASE("whatever fields are in conflict, a sweep looks at all of them") {
  test::each_random(300, [](test::Random& random) {
    Design design = random.chance(0.5) ? test::random_extreme_design(random)
                                       : test::random_hanging_design(random);
    if (random.chance(0.3)) design.tether.model = TetherModel::straight;
    if (random.chance(0.3)) design.tether.drum.core_diameter = random.magnitude(0.01, 1);
    if (random.chance(0.5)) design.tether.drum.width = random.magnitude(1e-4, 1);
    if (random.chance(0.5)) design.tether.cross_section = random.magnitude(1e-8, 1e-4);
    if (random.chance(0.3)) design.flight.roughness_length = 10;
    const auto told = [](const Design& asked) {
      std::vector<std::string> messages;
      for (const FieldConflict& one : find_conflicts(asked)) messages.push_back(one.message);
      return messages;
    };
    const std::vector<std::string> before = told(design);
    for (const SpecField& field : spec_fields()) {
      if (may_conflict(dot_path(field.pointer))) continue;
      INFO(field.pointer);
      if (is_numeric(field)) {
        for (const double end : {field.range.min, field.range.max}) {
          Design changed = design;
          if (!field.range.contains(end)) continue;
          set_field(changed, field, end);
          CHECK(told(changed) == before);
        }
      }
      for (std::size_t word = 0; word < field_words(field.kind).size(); ++word) {
        Design changed = design;
        set_word(changed, field, word);
        CHECK(told(changed) == before);
      }
    }
  });
}

TEST_CASE("a sweep is refused where one of its rows alone would be, and for the same reason") {
  struct Refused {
    std::vector<std::string> fixed;
    std::vector<std::string> varied;
    std::string because;
  };
  const std::vector<Refused> all{
      {{}, {"flight.horizontal_offset_m=1,20"}, "give tether.model solved"},
      {{}, {"flight.horizontal_offset_m=0:20:0.001"}, "give tether.model solved"},
      {{"tether.model=solved", "flight.horizontal_offset_m=5"},
       {"tether.model=all"},
       "give tether.model solved"},
      {{}, {"tether.drag_by_reynolds_number=all"}, "give tether.model solved"},
      {{}, {"tether.drum.width_mm=0,20"}, "both a core's diameter and a width"},
      {{"tether.model=solved", "flight.wind_reference_height_m=2"},
       {"flight.wind_profile=all", "flight.roughness_length_m=0.03,2"},
       "2 m is not less than the 2 m over ground"},
      {{"flight.roughness_length_m=5"},
       {"tether.length_m=30,4", "flight.wind_profile=logarithmic"},
       "5 m is not less than the 4 m over ground"},
      {{"tether.drum.core_diameter_mm=100", "tether.drum.width_mm=100"},
       {"tether.drum.width_mm=100,1"},
       "hold no turn"}};
  for (const auto& [fixed, varied, because] : all) {
    INFO(varied.front());
    const DesignFile file = parse_design(starting_spec(), "start.json", {}, fixed);
    CHECK_THROWS_WITH(read_sweep_space(varied, file), Contains(because));
    CHECK_THROWS_WITH(read_sweep_space(varied, file, SampleRequest{.draws = 100}),
                      Contains(because));
  }
}
