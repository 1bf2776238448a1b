// The commands that look for whole designs and for what a design can do at most.
#pragma once

#include "cli/design_commands.hpp"
#include "tethercalc/io/design_request.hpp"

namespace tethercalc::cli {

/// Returns its exit code and throws InputError for bad input.
int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output);

/// The envelope of one cross-section: that of the options, or the spec's own.
int run_envelope(const EvaluateOptions& options, const Output& output);

}  // namespace tethercalc::cli
