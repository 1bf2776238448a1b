// The commands that answer questions about one design.
#pragma once

#include <string>
#include <vector>

#include "cli/output.hpp"
#include "tethercalc/io/library.hpp"

namespace tethercalc::cli {

/// A spec and what the command line changes in it.
struct SpecOptions {
  std::string file;  ///< "-" is standard input
  std::vector<std::string> overrides;
};

/// The motors that `--motors` names: "all", names of the library, or files. Throws InputError with
/// every name that there is none of.
[[nodiscard]] std::vector<MotorEntry> chosen_motors(const std::vector<std::string>& names);

/// Each command returns its exit code and throws InputError for bad input.
int run_optimize(const SpecOptions& spec, const Output& output);

struct EvaluateOptions {
  SpecOptions spec;
  std::vector<double> areas_mm2;  ///< empty: the spec's own cross-section
};
int run_evaluate(const EvaluateOptions& options, const Output& output);

struct CompareOptions {
  SpecOptions spec;
  std::vector<std::string> motors;  ///< "all", names of the library, or files
};
int run_compare(const CompareOptions& options, const Output& output);

/// Reads specs and says what is wrong with them, or that nothing is.
int run_validate(const std::vector<std::string>& files, const std::vector<std::string>& overrides,
                 const Output& output);

int run_schema(const Output& output);

/// A starting spec.
int run_init(const Output& output);

/// `what`: "motors", "conductors", "insulation" or "sizes".
int run_list(const std::string& what, const Output& output);

}  // namespace tethercalc::cli
