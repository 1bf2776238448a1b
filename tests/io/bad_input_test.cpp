#include <catch2/catch.hpp>

#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>

#include "cli/bad_input_cases.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/design_reader.hpp"

using namespace tethercalc;

TEST_CASE("every kind of bad input is refused with a message that helps") {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("tethercalc-bad-input-" + std::to_string(std::random_device{}()));
  const auto cases = bad_input::prepare(TETHERCALC_SOURCE_DIR, folder);
  CHECK(cases.size() >= 40);
  for (const bad_input::Case& bad : cases) {
    INFO(bad.name);
    // For root no file is unreadable; the test of the program leaves root for it.
    if (bad.name == "an unreadable file" && geteuid() == 0) continue;
    try {
      (void)read_design(bad.spec, bad.overrides);
      FAIL_CHECK("was accepted");
    } catch (const InputError& error) {
      INFO(error.what());
      for (const std::string& fragment : bad.says) {
        CHECK_THAT(error.what(), Catch::Contains(fragment));
      }
      for (const InputProblem& problem : error.problems()) {
        CHECK_FALSE(problem.where.empty());
        CHECK_FALSE(problem.message.empty());
      }
    }
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("all problems are reported, and a flood of them is counted") {
  std::string text = "{";
  for (int i = 0; i < 500; ++i) text += "\"key" + std::to_string(i) + "\": 1,";
  text += "\"name\": \"a\"}";
  try {
    (void)parse_design(text, "flood.json");
    FAIL("must throw");
  } catch (const InputError& error) {
    CHECK(error.problems().size() == 101);
    CHECK_THAT(error.what(), Catch::Contains("more problems"));
  }
}
