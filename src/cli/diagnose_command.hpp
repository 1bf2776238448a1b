// The command that tells what the simulation of a measured flight gets wrong.
#pragma once

#include <string>

#include "cli/design_commands.hpp"
#include "cli/flight_options.hpp"
#include "cli/output.hpp"
#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/io/design_reader.hpp"

namespace tethercalc::cli {

struct DiagnoseOptions {
  SpecOptions spec;
  std::string flight_log;
  std::string power_log;
  std::vector<std::string> base;  ///< ids of effects that are part of the base model
  FlightOptions flight;
  bool into = false;  ///< print the extended spec instead of the diagnosis
};

/// The diagnosis alone, without its impact on the design. Throws InputError for bad input.
[[nodiscard]] Diagnosis diagnose(const DiagnoseOptions& options);

/// The diagnosis with its impact on the design, whose spec has been read already.
[[nodiscard]] Diagnosis diagnose_with_impact(const DiagnoseOptions& options,
                                             const DesignFile& file);

int run_diagnose(const DiagnoseOptions& options, const Output& output);

}  // namespace tethercalc::cli
