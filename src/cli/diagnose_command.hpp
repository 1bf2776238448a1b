// The command that tells what the simulation of a measured flight gets wrong.
#pragma once

#include <string>

#include "cli/design_commands.hpp"
#include "cli/flight_options.hpp"
#include "cli/output.hpp"

namespace tethercalc::cli {

struct DiagnoseOptions {
  SpecOptions spec;
  std::string flight_log;
  std::string power_log;
  std::vector<std::string> base;  ///< ids of effects that are part of the base model
  FlightOptions flight;
  bool into = false;      ///< print the extended spec instead of the diagnosis
  std::string into_file;  ///< write it there instead, beside the diagnosis
};
int run_diagnose(const DiagnoseOptions& options, const Output& output);

}  // namespace tethercalc::cli
