// The command that draws results.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/design_commands.hpp"
#include "cli/flight_options.hpp"

namespace tethercalc::cli {

struct PlotOptions {
  std::string kind;                ///< as in `plot_kinds`
  std::vector<std::string> files;  ///< the spec, logs or CSV that the kind is drawn from
  std::vector<std::string> overrides;
  std::string output;  ///< empty: characters on standard output
  std::string title;   ///< above the figure; empty: the design's or the file's name
  double width_mm = 85;
  std::vector<std::string> motors;
  FlightOptions flight;
  std::string flight_log;
  std::string power_log;
  std::vector<std::string> base;
  std::string view;
  std::string x;
  std::string y;
  std::string value;
};

/// Names and what they show, for help and messages.
[[nodiscard]] std::string plot_kinds_help();

/// Draws one figure. Returns an exit code; throws InputError for bad input.
int run_plot(const PlotOptions& options);

}  // namespace tethercalc::cli
