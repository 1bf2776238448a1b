// Reference designs guarded against drift.
#pragma once

#include <string>
#include <vector>

#include "cli/output.hpp"

namespace tethercalc::cli {

struct CheckOptions {
  std::vector<std::string> paths;  ///< folders, specs or records
  bool update = false;             ///< bring the records up to date
  std::string junit_file;          ///< empty: none
};

/// Exit code 1 where a design drifted or has no record, unless it was updated. Throws InputError
/// where a file could not be checked, after all others were.
int run_check(const CheckOptions& options, const Output& output);

}  // namespace tethercalc::cli
