// Bad input through the program itself.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include "cli/bad_input_cases.hpp"

namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

struct Outcome {
  int exit_code = 0;
  std::string standard_output;
  std::string standard_error;
};

Outcome optimize(const bad_input::Case& bad, const fs::path& folder) {
  const fs::path output = folder / "output";
  const fs::path error = folder / "error";
  std::string command = quoted(TETHERCALC_COMMAND) + " optimize " + quoted(bad.spec);
  for (const std::string& override_text : bad.overrides) {
    command += " --set " + quoted(override_text);
  }
  command += " > " + quoted(output.string()) + " 2> " + quoted(error.string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bad_input::text_of(output),
          bad_input::text_of(error)};
}

}  // namespace

TEST_CASE("the program refuses every kind of bad input with exit code 2, on standard error only") {
  const fs::path folder = fs::temp_directory_path() /
                          ("tethercalc-bad-input-" + std::to_string(std::random_device{}()));
  for (const bad_input::Case& bad : bad_input::prepare(TETHERCALC_SOURCE_DIR, folder)) {
    INFO(bad.name);
    const Outcome outcome = optimize(bad, folder);
    INFO(outcome.standard_error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.standard_output.empty());
    for (const std::string& fragment : bad.says) {
      CHECK_THAT(outcome.standard_error, Catch::Contains(fragment));
    }
  }
  fs::remove_all(folder);
}
