// The command that makes one page of everything about a design.
#pragma once

#include <span>
#include <string>

#include "cli/diagnose_command.hpp"
#include "cli/output.hpp"

namespace tethercalc::cli {

/// Writes the page. `options` names the spec and the logs, which may both be there; `command` is
/// what was typed, for a shell. Returns the exit code of `optimize` for the spec; throws InputError
/// for bad input.
int run_report(const DiagnoseOptions& options, const std::string& command, const Output& output);

/// The command line, given with the program's name, as one may type it into a shell again.
[[nodiscard]] std::string shell_command(std::span<const char* const> arguments);

}  // namespace tethercalc::cli
