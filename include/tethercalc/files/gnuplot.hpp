// Figures drawn by the program gnuplot: those as PDF and PNG.
#pragma once

#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// Runs the program `gnuplot` found on PATH, without a shell and without the user's settings, and
/// returns what it draws. A character that no font of the machine has is drawn as a box. Throws
/// InputError naming the Debian package where there is no gnuplot, std::runtime_error with
/// gnuplot's own words where it fails. Takes 50 to 200 ms.
[[nodiscard]] std::string run_gnuplot(const std::string& script);

}  // namespace tethercalc
