// The command that tells what the simulation of a measured flight gets wrong.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
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
  bool into = false;      ///< print the extended spec instead of the diagnosis
  std::string into_file;  ///< write it there instead, beside the diagnosis
};

/// What the logs say; either may be absent.
struct ToldDiagnosis {
  std::optional<Diagnosis> flight;
  std::optional<Diagnosis> power;
  nlohmann::ordered_json extended;  ///< the spec with the findings of both
};

/// Compares each log that `options` name with the spec as it stands; what both together do to the
/// design stands in the last of them. Drag that a flight shows directly outranks what the power at
/// the motors says of it. Throws InputError for bad input.
[[nodiscard]] ToldDiagnosis diagnose_logs(const DiagnoseOptions& options, const DesignFile& file);

int run_diagnose(const DiagnoseOptions& options, const Output& output);

}  // namespace tethercalc::cli
