// The files that are made from the table of fields and committed for people who read them.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tethercalc/io/spec_fields.hpp"

using namespace tethercalc;

namespace {

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
