// Bad input through the program itself.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "cli/bad_input_cases.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;

namespace {

/// For root every file is readable: there, the unreadable one is for nobody (65534) to read, with a
/// copy of the program that nobody may run wherever the original lies.
std::string program_for(const bad_input::Case& bad, const std::filesystem::path& folder) {
  if (bad.name != "an unreadable file" || geteuid() != 0) return shell_quoted(TETHERCALC_COMMAND);
  const std::filesystem::path copy = folder / "tethercalc";
  std::filesystem::copy_file(TETHERCALC_COMMAND, copy);
  return "setpriv --reuid=65534 --clear-groups " + shell_quoted(copy.string());
}

}  // namespace

TEST_CASE("the program refuses every kind of bad input with exit code 2, on standard error only") {
  const TemporaryFolder folder;
  for (const bad_input::Case& bad : bad_input::prepare(TETHERCALC_SOURCE_DIR, folder.path())) {
    std::string line = program_for(bad, folder.path()) + " optimize " + shell_quoted(bad.spec);
    for (const std::string& change : bad.overrides) line += " --set " + shell_quoted(change);
    const Ran run = run_shell(line);
    INFO(bad.name << ": " << run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    for (const std::string& fragment : bad.says) CHECK_THAT(run.err, Catch::Contains(fragment));
  }
}
