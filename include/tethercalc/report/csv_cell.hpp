// Cells of a CSV file.
#pragma once

#include <string>

namespace tethercalc {

/// A text as one cell, quoted where it has to be (RFC 4180).
[[nodiscard]] std::string csv_text(const std::string& text);

/// The shortest text that reads back as the same number; empty where it does not exist.
[[nodiscard]] std::string csv_number(double value);

}  // namespace tethercalc
