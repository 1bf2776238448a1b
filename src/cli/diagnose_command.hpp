// The command that tells what the simulation of a measured flight gets wrong.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// A diagnosis with the spec that it leads to.
struct ToldDiagnosis {
  Diagnosis diagnosis;
  nlohmann::ordered_json extended;
};

/// Diagnoses the one log that `options` name, and says what that does to the design. Throws
/// InputError where the log is not fit for it.
[[nodiscard]] ToldDiagnosis diagnose_log(const DiagnoseOptions& options, const DesignFile& file);

int run_diagnose(const DiagnoseOptions& options, const Output& output);

}  // namespace tethercalc::cli
