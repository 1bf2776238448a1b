// The published design, and what is known of the example flight: most tests of commands read them.
#pragma once

#include <string>
#include <vector>

#include "support/run_program.hpp"

namespace tethercalc::test {

inline const std::string published = project_file("examples/holybro-x500.json");

/// What examples/README.md says of the simulated flight.
inline const std::vector<std::string> known{"--mass-g",           "1550", "--air-density", "1.225",
                                            "--pitch-offset-deg", "0.8"};

}  // namespace tethercalc::test
