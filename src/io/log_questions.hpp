// What is asked of measured logs, as typed: which part of a flight counts, what is known about it,
// and which logs are held against a design.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tethercalc/identify/observations.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/warning.hpp"
#include "tethercalc/study/diagnosis.hpp"
#include "tethercalc/study/drag.hpp"

namespace tethercalc {

/// What reads the logs that options name.
struct LogReaders {
  std::function<FlightLogReading(const std::string& name, const FlightLogOptions&)> flight;
  std::function<PowerLogReading(const std::string& name, const PowerLogOptions&)> power;
};

/// Takes what was amiss with a log.
using NoteTaker = std::function<void(const Warning& note)>;

/// Which part of which flight log is looked at, and what is known about the flight; what is empty
/// was not given.
struct FlightOptions {
  int core = 0;
  std::string from;  ///< "25%" of the samples, or seconds of the log's clock
  std::string to;
  std::string trim_log;  ///< a hover flight whose mean pitch is the offset
  std::optional<double> pitch_offset_deg;
  std::optional<double> mass_g;
  std::optional<double> air_density_kg_m3;
  std::optional<double> pressure_hPa;
  std::optional<double> temperature_C;
  bool published_kinematics = false;
  std::vector<std::string> columns{};    ///< of logs in CSV, as in FlightLogOptions
  std::optional<double> gravity_m_s2{};  ///< never typed: of the design, see flown_as
};

/// Where the part of the log begins or ends that `text`, as given to `option`, names: percent of
/// the samples with a "%", else seconds; nothing for an empty text. Throws InputError for anything
/// else.
[[nodiscard]] std::optional<LogPosition> log_position(const std::string& option,
                                                      const std::string& text);

/// rad: given, from the trim log, or 0.
[[nodiscard]] double pitch_offset(const FlightOptions& options, const LogReaders& read);

/// The mass in kg that was given, if any. Throws InputError where it is out of range.
[[nodiscard]] std::optional<double> flown_mass(const FlightOptions& options);

/// kg/m³: given, or from pressure and temperature; nothing where neither was. Throws InputError for
/// impossible values, half a pair, or both.
[[nodiscard]] std::optional<double> air_density(const FlightOptions& options);

/// The options with mass and air as `design` has them where they do not say, and its gravity.
[[nodiscard]] FlightOptions flown_as(FlightOptions options, const Design& design);

/// The numbers of battery monitors as typed for --battery. Throws InputError for what is none.
[[nodiscard]] std::vector<int> battery_numbers(const std::vector<std::string>& typed);

/// What the options say about the flight, checked; the mass must be given.
[[nodiscard]] DragIdentificationOptions identification_options(const FlightOptions& flight,
                                                               const LogReaders& read);

/// The logs of these names.
[[nodiscard]] std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names,
                                                      const FlightOptions& flight,
                                                      const LogReaders& read,
                                                      const NoteTaker& note);

/// What stands above the answer about these logs: the file name of the only one, or how many
/// flights they are.
[[nodiscard]] std::string heading_of(const std::vector<std::string>& logs);

/// The drag of logs, and what is to be said of it.
struct LearnedDrag {
  DragStudy study;
  std::vector<Warning> notes;    ///< on how the logs were read, then `assumed`
  std::vector<Warning> assumed;  ///< what was not said and moves the answer
};

/// The drag of these logs, under their `heading_of`. `note` hears of each log as it is read, so
/// that its notes are told even where nothing can be learned. Throws InputError where they show no
/// drag.
[[nodiscard]] LearnedDrag learned_drag(const std::vector<std::string>& logs,
                                       const FlightOptions& flight, const LogReaders& read,
                                       const NoteTaker& note = {});

/// The logs that a design is held against, and how.
struct LogsAsked {
  std::vector<std::string> flight_logs;  ///< flights of one drone
  std::vector<std::string> power_logs;   ///< likewise; several of free flights only
  std::vector<std::string> whole_logs;   ///< or: logs of both halves each, see with_halves
  std::vector<std::string> batteries;    ///< see battery_numbers
  bool free_flight = false;              ///< the power was logged without the tether
  std::vector<std::string> base;         ///< ids of effects that are part of the base model
  FlightOptions flight;
};

/// The options with the logs of both halves as the logs of each. Throws InputError where another
/// log stands beside them.
[[nodiscard]] LogsAsked with_halves(LogsAsked options);

/// Refuses options that say something of logs of which none was given, all of them at once;
/// `own_effects` says whether there are effects beside those of the catalogue.
void check_options_have_logs(const LogsAsked& options, bool own_effects);

/// A question with its logs, and what is to be said of how they were read.
struct AskedDiagnosis {
  DiagnosisQuestion question;
  std::vector<Warning> flight_notes;
  std::vector<Warning> power_notes;
};

/// The question that `options` put to `design`, with its logs read; `own` are effects beside those
/// of the catalogue. Throws InputError for bad input.
[[nodiscard]] AskedDiagnosis diagnosis_question(const LogsAsked& options, const Design& design,
                                                std::vector<Effect> own, const LogReaders& read);

/// The answer to `asked`, which `options` put; the notes on how a log was read stand before its
/// own. Throws InputError for a log that cannot be diagnosed.
[[nodiscard]] DiagnosisStudy studied_diagnosis(const AskedDiagnosis& asked,
                                               const LogsAsked& options,
                                               const SelectionProgress& progress = {});

}  // namespace tethercalc
