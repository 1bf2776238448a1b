// What a DataFlash log holds, at a glance.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/dataflash.hpp"

namespace tethercalc {

/// Summary of a log. Times are seconds since the controller started.
///
/// A time more than a minute away from that of the message before it counts only if the next timed
/// message agrees with it; so a flipped bit does not make a flight last for years.
struct LogSummary : DataFlashTotals {
  /// All messages of one name.
  struct Message {
    std::string name;                 ///< as in the log
    std::size_t count = 0;            ///< number of messages
    std::vector<std::string> fields;  ///< names of its fields
    // The following only where messages of this name carry a time.
    std::optional<double> first_time;   ///< s, the earliest
    std::optional<double> last_time;    ///< s, the latest
    std::optional<double> rate;         ///< 1/s, all instances together; needs two different times
    std::optional<double> longest_gap;  ///< s between two in succession; needs two messages
  };
  /// A stretch without timed messages.
  struct Gap {
    double start = 0;     ///< s, time of the last message before it
    double duration = 0;  ///< s
  };
  /// Time in the air.
  struct Flying {
    double duration = 0;        ///< s
    std::string determined_by;  ///< a phrase: from what the duration was told
  };

  std::vector<Message> types;        ///< in alphabetical order of their names; all with messages
  std::optional<double> first_time;  ///< s; nothing where no message carries a time
  std::optional<double> last_time;   ///< s
  std::vector<Gap> gaps;      ///< over 1 s without any timed message, in order; the first 100
  std::size_t gap_count = 0;  ///< all of them, also beyond the first 100
  std::size_t implausible_times = 0;  ///< messages whose time was not believed
  std::optional<Flying> flying;       ///< nothing where the log does not tell
  std::string firmware;  ///< first text message, which names it in most logs; may be empty
};

/// Reads the whole log. Nothing is thrown: any bytes are a log, if only an empty one.
///
/// Flying time is told by the controller's own events where the log has any: from "not landed" to
/// "land complete" (EV 28 and 18, ArduPilot's AP_Logger.h, LogEvent), from the log's beginning if
/// it starts in the air and to its end if it ends there. Otherwise it is estimated from EKF core 0:
/// the time that the drone moves at 0.5 m/s or more for at least 2 s, pauses up to 10 s included.
[[nodiscard]] LogSummary summarize_log(std::span<const std::byte> log);

}  // namespace tethercalc
