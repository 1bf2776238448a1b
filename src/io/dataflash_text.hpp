// DataFlash logs as text (`.log`): a message a line, its name and values separated by commas, as
// Mission Planner writes them and older firmware sent them. The definitions are there:
//
//   FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns
//   FMT, 64, 37, XKF1, QBccCfff, TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD
//   XKF1, 1000000, 0, -5.61, 2.3, 271.2, 0.1, -0.3, 0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/log_messages.hpp"

namespace tethercalc {

/// A text written as a binary log.
struct DataFlashTranscript {
  /// Every line that can be read, as a message. Numbers that the binary log would hold rounded, or
  /// scaled to hundredths or 1e-7 degrees, are kept as they stand; so are flight modes, which the
  /// text has by name.
  std::vector<std::byte> messages;
  std::vector<SkippedBytes> skipped;  ///< lines that are no message, in order
  std::vector<std::string> rejected;  ///< definitions that could not be used
};

/// Reads the text. A line counts only if its message was defined before it, it has as many values
/// as that definition, each of the kind that it says, and an end: what a cut left of the last line
/// may be a number without its last digits.
[[nodiscard]] DataFlashTranscript transcribe_dataflash(std::span<const std::byte> text);

}  // namespace tethercalc
