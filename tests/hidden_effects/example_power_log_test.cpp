// The example power log is what the simulator of these tests flies, and holds what is said of it.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "hidden_effects/power_scenarios.hpp"
#include "support/log_csv.hpp"

using namespace power_truth;

namespace {

const std::string example_file =
    std::string(TETHERCALC_SOURCE_DIR) + "/examples/simulated-power.csv";

/// As told in examples/README.md.
std::string example_text() {
  Scenario scenario;
  scenario.hidden.contact_resistance = 0.3;
  scenario.hidden.extra_mass = 0.15;
  scenario.seed = 2024;
  scenario.duration = 900;
  return tethercalc::test::power_csv_text(as_power_log(simulate(scenario)), 3);
}

}  // namespace

TEST_CASE("the example power log is the simulator's flight of seed 2024") {
  if (std::getenv("TETHERCALC_UPDATE") != nullptr) std::ofstream(example_file) << example_text();
  std::ifstream file(example_file);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  CHECK(text.size() < 300'000);
  CHECK(text == example_text());
}
