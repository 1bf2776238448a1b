#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "io/design_numbers.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/operating_point.hpp"

using namespace tethercalc;
using test::numbers_of;

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const fs::path examples = fs::path(TETHERCALC_SOURCE_DIR) / "examples";
const std::string published = (examples / "holybro-x500.json").string();

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Json shuffled(const Json& value, std::mt19937& random) {
  if (!value.is_object()) return value;
  std::vector<std::string> keys;
  for (const auto& [key, member] : value.items()) keys.push_back(key);
  std::shuffle(keys.begin(), keys.end(), random);
  Json result = Json::object();
  for (const std::string& key : keys) result[key] = shuffled(value.at(key), random);
  return result;
}

}  // namespace

TEST_CASE("the starting spec is valid as it stands and holds every required field") {
  const DesignFile file = parse_design(starting_spec(), "new.json");
  CHECK(file.warnings.empty());
  CHECK(file.name == "My tethered drone");
  for (const SpecField& field : spec_fields()) {
    if (!field.required()) continue;
    INFO(field.pointer);
    CHECK(file.document.contains(Json::json_pointer(std::string(field.pointer))));
  }
}

TEST_CASE("the published design arrives in SI units") {
  const DesignFile file = read_design(published);
  const Design& design = file.design;
  CHECK(file.name == "Holybro X500 V2, 75 V aluminium");
  CHECK(design.drone.mass == Approx(1.710).epsilon(1e-15));
  CHECK(design.drone.motor_count == 4);
  // Data sheet: 1332 g at full throttle with 5.13 g/W.
  CHECK(design.drone.motor.max_thrust() == Approx(1.332 * 9.80665).epsilon(1e-15));
  CHECK(design.drone.motor.max_power() == Approx(1332 / 5.13).epsilon(1e-15));
  CHECK(design.tether.conductor.resistivity_20C == Approx(2.78e-8).epsilon(1e-15));
  CHECK(design.tether.conductor.density == Approx(2700).epsilon(1e-15));
  CHECK(design.tether.insulation.density == Approx(1360).epsilon(1e-15));
  CHECK(design.tether.insulation.thickness == Approx(0.75e-3).epsilon(1e-15));
  CHECK(design.requirements.max_pitch == Approx(std::numbers::pi / 4).epsilon(1e-15));
  CHECK(design.flight.gravity == 9.80665);
  // The paper's figures at its optimum of 1.0886 mm².
  CHECK(evaluate(design, 1.0886e-6, Condition::hover).total_power == Approx(405.4).margin(0.05));
  CHECK(evaluate(design, 1.0886e-6, Condition::forward).total_power == Approx(444.9).margin(0.05));
}

TEST_CASE("every example reads without a warning") {
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(examples)) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    CHECK(read_design(entry.path().string()).warnings.empty());
    ++count;
  }
  CHECK(count >= 1);
}

TEST_CASE("the spec of the power logs reads, its cable included") {
  const auto path = test::reference_file("data/practice/x500-tethered.spec.json");
  if (!path) return;
  const DesignFile file = read_design(path->string());
  REQUIRE(file.design.tether.cross_section);
  CHECK(*file.design.tether.cross_section == Approx(1.09e-6).epsilon(1e-15));
}

TEST_CASE("an override equals editing the file") {
  struct Edit {
    const char* option;
    const char* pointer;
    const char* value;
  };
  const auto edit = GENERATE(
      Edit{"supply.voltage_V=60", "/supply/voltage_V", "60"},
      Edit{"/supply/voltage_V=60.5", "/supply/voltage_V", "60.5"},
      Edit{"drone.motor=tmotor-mn2806-650kv-13in", "/drone/motor", "\"tmotor-mn2806-650kv-13in\""},
      Edit{"tether.conductor=\"copper\"", "/tether/conductor", "\"copper\""},
      Edit{"tether.insulation.material={\"density_g_cm3\": 2}", "/tether/insulation/material",
           "{\"density_g_cm3\": 2}"},
      Edit{"requirements.headroom_at=forward", "/requirements/headroom_at", "\"forward\""},
      Edit{"requirements.buffer_battery=true", "/requirements/buffer_battery", "true"},
      Edit{"supply.converter.efficiency=[{\"output_W\":100,\"efficiency\":0.8},"
           "{\"output_W\":500,\"efficiency\":0.93}]",
           "/supply/converter/efficiency",
           "[{\"output_W\":100,\"efficiency\":0.8},{\"output_W\":500,\"efficiency\":0.93}]"},
      Edit{"tether.cross_section_mm2=1.5", "/tether/cross_section_mm2", "1.5"},
      Edit{"flight.headwind_m_s=-3", "/flight/headwind_m_s", "-3"},
      Edit{"supply.converter={\"efficiency\":0.8,\"min_input_voltage_V\":30}", "/supply/converter",
           "{\"efficiency\":0.8,\"min_input_voltage_V\":30}"});
  INFO(edit.option);
  Json edited = Json::parse(text_of(published));
  edited[Json::json_pointer(edit.pointer)] = Json::parse(edit.value);
  const std::vector<std::string> overrides{edit.option};
  const DesignFile by_option = read_design(published, overrides);
  const DesignFile by_hand = parse_design(edited.dump(), "edited.json");
  CHECK(by_option.document == edited);
  CHECK(numbers_of(by_option.design) == numbers_of(by_hand.design));
  CHECK(numbers_of(by_option.design) != numbers_of(read_design(published).design));
}

TEST_CASE("of two overrides of one field the later wins") {
  const std::vector<std::string> overrides{"supply.voltage_V=60", "supply.voltage_V=90"};
  CHECK(read_design(published, overrides).design.supply.voltage == 90);
}

TEST_CASE("the order of keys changes nothing") {
  std::mt19937 random(test::run_seed());
  const Json original = Json::parse(text_of(published));
  const std::vector<double> expected = numbers_of(read_design(published).design);
  for (int i = 0; i < 20; ++i) {
    const Json other = shuffled(original, random);
    INFO(other.dump());
    CHECK(numbers_of(parse_design(other.dump(), "other.json").design) == expected);
  }
}

TEST_CASE("what was read can be written and read again") {
  const DesignFile file = read_design(published);
  const DesignFile again = read_design_document(file.document, "again.json");
  CHECK(numbers_of(again.design) == numbers_of(file.design));
  CHECK(again.document.dump() == file.document.dump());
}

TEST_CASE("an object in place of a library name gives the same design") {
  const DesignFile named = read_design(published);
  Json document = named.document;
  const fs::path data = fs::path(TETHERCALC_SOURCE_DIR) / "data";
  document["drone"]["motor"] =
      Json::parse(text_of(data / "motors/holybro-air2216-920kv-10in.json"));
  document["tether"]["conductor"] = Json::parse(text_of(data / "conductors/aluminium.json"));
  document["tether"]["insulation"]["material"] = Json::parse(text_of(data / "insulation/pvc.json"));
  CHECK(numbers_of(read_design_document(document, "inline.json").design) ==
        numbers_of(named.design));
}

TEST_CASE("paths in a spec are relative to the spec") {
  const std::vector<std::string> overrides{
      "drone.motor=../data/motors/tmotor-mn4014-400kv-15in.json",
      "tether.conductor=../data/conductors/copper.json"};
  const DesignFile file = read_design(published, overrides);
  CHECK(file.motor.id == "tmotor-mn4014-400kv-15in");
  CHECK(file.conductor.id == "copper");
}

TEST_CASE("a byte order mark is skipped") {
  CHECK(numbers_of(parse_design("\xEF\xBB\xBF" + text_of(published), "bom.json").design) ==
        numbers_of(read_design(published).design));
}

TEST_CASE("every numeric field takes its value by name as it does from a file") {
  const DesignFile file = read_design(published);
  for (const SpecField& field : spec_fields()) {
    if (!is_numeric(field)) continue;
    INFO(field.pointer);
    const double value = field.kind == FieldKind::integer ? 6 : 0.5 + field.range.min;
    Design design = file.design;
    if (!field.range.contains(value)) continue;
    set_field(design, field, value);
    CHECK(*field_value(design, field) == Approx(value).epsilon(1e-14));
    Json document = file.document;
    document[Json::json_pointer(std::string(field.pointer))] = value;
    if (!find_conflicts(design).empty()) continue;
    CHECK(numbers_of(read_design_document(document, "set.json").design) == numbers_of(design));
    CHECK_THROWS_AS(set_field(design, field, std::nan("")), std::invalid_argument);
    CHECK_THROWS_AS(set_field(design, field, 2 * field.range.max + 1), std::invalid_argument);
  }
}

TEST_CASE("an override that is no UTF-8 is refused") {
  const std::vector<std::string> overrides{"name=\xff"};
  CHECK_THROWS_WITH(read_design(published, overrides), Catch::Contains("is not valid UTF-8"));
}

TEST_CASE("a design without a name is called after its file, whatever bytes that holds") {
  Json document = Json::parse(starting_spec());
  document.erase("name");
  CHECK(parse_design(document.dump(), "a/my drone.json").name == "my drone");
  CHECK(parse_design(document.dump(), "\xff.json").name == "\xEF\xBF\xBD");
}
