// The program's command line.
#pragma once

namespace tethercalc::cli {

/// Parses the arguments, runs the command, and returns the exit code. Messages about bad arguments
/// and bad input have gone to standard error by then.
int run(int argc, const char* const* argv);

}  // namespace tethercalc::cli
