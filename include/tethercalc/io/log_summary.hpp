// What an autopilot's log holds, at a glance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// Summary of a log. Times are seconds since the controller started.
///
/// A time more than a minute away from that of the message before it counts only if the next timed
/// message agrees with it; so a flipped bit does not make a flight last for years.
struct LogSummary : LogTotals {
  /// All messages of one name.
  struct Message {
    std::string name;                 ///< as in the log
    std::size_t count = 0;            ///< number of messages
    std::vector<std::string> fields;  ///< names of its fields
    std::vector<std::string> units;   ///< theirs; empty texts where the log does not tell
    std::vector<int> instances;       ///< sensors or estimators that wrote it; empty where not told
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
  /// From take-off to landing.
  struct Flight {
    double start = 0;  ///< s
    double end = 0;    ///< s
  };
  /// Time in the air.
  struct Flying {
    double duration = 0;        ///< s, of all flights
    std::string determined_by;  ///< a phrase: from what it was told
    /// In order; empty where it was told from the speed, which a hover lacks as a landing does.
    std::vector<Flight> flights;
    /// From the first take-off or movement to the last landing or movement; nothing where there is
    /// none.
    std::optional<Flight> whole;
  };
  /// A battery, or another source whose voltage the controller measures.
  struct Battery {
    std::string message;          ///< where it is told: "BAT", "battery_status"
    std::optional<int> instance;  ///< which of several
    std::size_t samples = 0;      ///< at least 1
    double least_voltage = 0;     ///< V
    double mean_voltage = 0;      ///< V, over the samples
    double greatest_voltage = 0;  ///< V
    // Where the current was measured, too.
    std::optional<double> mean_current;      ///< A, over the samples
    std::optional<double> greatest_current;  ///< A
    std::optional<double> energy;  ///< J, voltage times current over time, gaps over 5 s left out
  };
  /// The wind as the estimator guesses it, over its messages.
  struct Wind {
    std::string message;    ///< where it is told: "XKF2", "wind"
    double mean_speed = 0;  ///< m/s, of the mean vector
    double from_deg = 0;    ///< where the mean comes from, 0 to 360, clockwise from north
  };
  /// Whether a command can use the log.
  struct Use {
    std::string command;    ///< "drag", "diagnose --flight", "diagnose --power"
    bool possible = false;  ///< whether it can
    std::string because;    ///< what it would take from the log, or what is in the way
  };

  LogFormat format = LogFormat::dataflash;  ///< which kind of log it is
  std::vector<Message> types;        ///< in alphabetical order of their names; all with messages
  std::optional<double> first_time;  ///< s; nothing where no message carries a time
  std::optional<double> last_time;   ///< s
  std::vector<Gap> gaps;      ///< over 1 s without any timed message, in order; the first 100
  std::size_t gap_count = 0;  ///< all of them, also beyond the first 100
  std::size_t implausible_times = 0;           ///< messages whose time was not believed
  std::vector<LogContents::Dropout> dropouts;  ///< where the controller could not write (ULog)
  std::optional<Flying> flying;                ///< nothing where the log does not tell
  std::string firmware;  ///< its name and version, or its first words; may be empty
  std::string vehicle;   ///< "a multirotor", "an aeroplane"; empty where the log does not tell
  std::vector<Battery> batteries;  ///< those with a voltage
  std::optional<Wind> wind;        ///< nothing where the estimator guesses none
  std::vector<Use> uses;           ///< one a command
};

/// Reads the whole log.
///
/// Flights are told by the controller's own events where the log has any: from "not landed" to
/// "land complete" (EV 28 and 18, ArduPilot's AP_Logger.h, LogEvent), from the log's beginning if
/// it starts in the air; in ULog while vehicle_land_detected says that it is not landed. What is
/// landed for less than 2 s flies on: detectors bounce. A last flight without a landing ends as the
/// motors are disarmed (EV 11), or with the last movement (see below) if that is 10 s or more
/// before the end of the log, else with the log. Otherwise flights are estimated from the first
/// estimator: the time that the drone moves at 0.5 m/s or more for at least 2 s, pauses up to 10 s
/// included.
[[nodiscard]] LogSummary summarize_log(const AutopilotLog& log);

/// `LogSummary::flying` alone, sooner than all of it.
[[nodiscard]] std::optional<LogSummary::Flying> time_in_the_air(const AutopilotLog& log);

}  // namespace tethercalc
