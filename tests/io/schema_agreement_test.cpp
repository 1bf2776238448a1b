// The schema and the reader give the same verdict, judged by an independent implementation of JSON
// Schema (python3-jsonschema).
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"

using namespace tethercalc;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// A spec in which every kind of field and of object occurs.
Json full_spec() {
  Json spec = Json::parse(starting_spec());
  spec["drone"]["motor"] = Json::parse(R"({"name": "mine", "voltage_V": 16, "propeller_in": null,
      "points": [{"throttle_percent": 50, "thrust_g": 500, "power_W": 60},
                 {"thrust_g": 900, "efficiency_g_per_W": 6.5}]})");
  spec["tether"]["conductor"] = Json::parse(R"({"resistivity_20C_ohm_mm2_per_m": 0.028,
      "temperature_coefficient_per_K": 0.004, "density_g_cm3": 2.7})");
  spec["tether"]["insulation"]["material"] = Json::parse(R"({"density_g_cm3": 1.4})");
  spec["tether"]["cross_section_mm2"] = 1.5;
  spec["supply"]["converter"]["efficiency"] = Json::parse(
      R"([{"output_W": 100, "efficiency": 0.85}, {"output_W": 400, "efficiency": 0.9}])");
  spec["requirements"]["buffer_battery"] = false;
  return spec;
}

void collect_pointers(const Json& value, const std::string& at, std::vector<std::string>& all) {
  if (!at.empty()) all.push_back(at);
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) collect_pointers(member, at + "/" + key, all);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      collect_pointers(value[i], at + "/" + std::to_string(i), all);
    }
  }
}

/// Values that lie in some field's range and out of another's, and of every type. Library names are
/// left out, and so are texts in place of objects: what they name a schema cannot know.
Json odd_value(std::mt19937& random) {
  static const std::vector<Json> values{nullptr,
                                        true,
                                        0,
                                        1,
                                        2,
                                        3.9,
                                        4.0,
                                        -1,
                                        0.5,
                                        90,
                                        1e-9,
                                        1e7,
                                        1e30,
                                        64,
                                        Json::array(),
                                        Json::object(),
                                        "hover",
                                        44.99,
                                        250.5,
                                        Json::array({1})};
  return values[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random)];
}

void remove_at(Json& spec, const Json::json_pointer& at) {
  Json& parent = spec.at(at.parent_pointer());
  if (parent.is_array()) {
    parent.erase(std::stoul(at.back()));
  } else {
    parent.erase(at.back());
  }
}

Json mutated(Json spec, std::mt19937& random) {
  const int edits = std::uniform_int_distribution<int>(1, 2)(random);
  for (int i = 0; i < edits; ++i) {
    std::vector<std::string> pointers;
    collect_pointers(spec, "", pointers);
    const Json::json_pointer at(
        pointers[std::uniform_int_distribution<std::size_t>(0, pointers.size() - 1)(random)]);
    const int kind = std::uniform_int_distribution<int>(0, 5)(random);
    if (kind == 0) {
      remove_at(spec, at);
    } else if (kind == 1 && spec.at(at).is_object()) {
      spec[at]["extra"] = 1;
    } else {
      spec[at] = odd_value(random);
    }
  }
  return spec;
}

/// The reader's verdict on what a schema can see: nothing of conflicts, pooling and library names.
bool reader_accepts(const Json& spec) {
  try {
    (void)read_design_document(spec, "spec");
    return true;
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) {
      const auto says = [&](const char* words) {
        return problem.message.find(words) != std::string::npos;
      };
      const bool beyond_schema =
          says("the converter cuts off below") || says("of rising thrust") ||
          says("in the library (`tethercalc list") || says("has a figure of merit of") ||
          says("does not have a higher output power") || says("would draw less input power");
      if (!beyond_schema) return false;
    }
    return true;
  }
}

}  // namespace

TEST_CASE("schema and reader agree on mutated specs") {
  std::mt19937 random(test::run_seed());
  Json specs = Json::array({full_spec(), Json::parse(starting_spec())});
  std::string reader_verdicts = "11";
  CHECK(reader_accepts(specs[0]));
  CHECK(reader_accepts(specs[1]));
  for (int i = 0; i < 1500; ++i) {
    specs.push_back(mutated(i % 3 == 0 ? specs[1] : specs[0], random));
    reader_verdicts += reader_accepts(specs.back()) ? '1' : '0';
  }

  const fs::path folder =
      fs::temp_directory_path() / ("tethercalc-schema-" + std::to_string(std::random_device{}()));
  fs::create_directories(folder);
  std::ofstream(folder / "specs.json") << specs.dump();
  const std::string source = TETHERCALC_SOURCE_DIR;
  const std::string command = "/usr/bin/python3 '" + source + "/tests/io/schema_agreement.py' '" +
                              source + "/data/schema/design.schema.json' < '" +
                              (folder / "specs.json").string() + "' > '" +
                              (folder / "verdicts").string() + "'";
  const int status = std::system(command.c_str());
  std::string schema_verdicts;
  std::ifstream(folder / "verdicts") >> schema_verdicts;
  fs::remove_all(folder);
  if (!WIFEXITED(status) || WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) {
    std::puts("SKIPPED: python3-jsonschema is not installed");
    return;
  }
  REQUIRE(WEXITSTATUS(status) == 0);
  REQUIRE(schema_verdicts.size() == reader_verdicts.size());
  for (std::size_t i = 0; i < specs.size(); ++i) {
    INFO(specs[i].dump());
    CHECK(schema_verdicts[i] == reader_verdicts[i]);
  }
  // Both verdicts occur often, otherwise the comparison would say little.
  const auto accepted = std::count(reader_verdicts.begin(), reader_verdicts.end(), '1');
  CHECK(accepted > 75);
  CHECK(accepted < 1425);
}
