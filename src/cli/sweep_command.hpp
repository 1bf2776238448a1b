// Many designs in one run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/design_commands.hpp"

namespace tethercalc::cli {

struct SweepOptions {
  SpecOptions spec;
  std::vector<std::string> varied;      ///< see read_axes
  std::string format = "csv";           ///< "csv", or "jsonl" (also "json") for JSON Lines
  std::string file;                     ///< empty or "-": standard output
  bool resume = false;                  ///< continue what `file` holds
  std::string shard;                    ///< "i/n"; empty: all rows
  unsigned jobs = 0;                    ///< threads; 0: one a core
  std::optional<std::uint64_t> sample;  ///< draw this many instead of every combination
  std::string method = "sobol";         ///< or "lhs"
  std::uint64_t seed = 0;
  std::string summary_file;  ///< JSON summary of a sample; empty: none
};

/// Writes one row a design as they are computed. Returns an exit code, 128 + the signal's number
/// where it was interrupted; throws InputError for bad input and where rows cannot be written.
int run_sweep(const SweepOptions& options);

}  // namespace tethercalc::cli
