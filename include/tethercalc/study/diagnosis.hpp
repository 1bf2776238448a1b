// What the simulation of measured flights gets wrong, of one log or of a flight and a power log
// together, and how far the design moves once that is repaired.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"

namespace tethercalc {

/// Flights of one drone, and what their logs do not say.
struct LoggedFlight {
  std::vector<MeasuredFlight> flights;  ///< one at least
  FlightDiagnosisOptions options{};     ///< how to look
  std::optional<double> mass{};         ///< kg, where it was not the design's
  std::optional<double> air_density{};  ///< kg/m³, likewise
};

/// Power measured along the chain.
struct LoggedPower {
  PowerLog log;                         ///< currents and voltages
  std::vector<std::string> base{};      ///< ids of effects that are refitted but not reported
  std::optional<double> mass{};         ///< kg, where it was not the design's
  std::optional<double> air_density{};  ///< kg/m³, likewise
};

/// What is asked: one log at least.
struct DiagnosisQuestion {
  Design design;                         ///< as it stands
  std::optional<LoggedFlight> flight{};  ///< logs are held against that
  std::optional<LoggedPower> power{};    ///< likewise
  std::vector<Effect> hypotheses{};      ///< tried beside the catalogue, see `effect_of`
  bool one_flight =
      false;  ///< both logs are of one flight: the same drone at the same mass, judged together
};

/// The answer.
struct DiagnosisStudy {
  std::optional<Diagnosis> flight;  ///< of the flight logs, jointly
  std::optional<Diagnosis> power;  ///< of the power log; `design_impact` stands in the last of both
  Design extended;                 ///< the design with the findings of both
};

/// A log that cannot be diagnosed.
class UnsuitableLog : public std::invalid_argument {
 public:
  /// `why` the log of this kind cannot be.
  UnsuitableLog(LogKind which, const std::string& why) : std::invalid_argument(why), kind_(which) {}
  /// Which of the two it is.
  [[nodiscard]] LogKind kind() const { return kind_; }

 private:
  LogKind kind_;
};

/// Optimum cross-section and the supply power there, in the condition of `requirements.power_at`,
/// of the design as it was and as extended; empty where a design has no feasible cross-section.
[[nodiscard]] DesignImpact design_impact(const Design& before, const Design& after);

/// Compares each log with the design as it stands. Drag that a flight shows directly outranks what
/// the power at the motors says of it. Of one flight the power is judged with what the tilt says,
/// by the same mass and air, and the extended design is the one drone of both; where the tilt says
/// nothing of drag, a note of the power says that. Throws UnsuitableLog.
[[nodiscard]] DiagnosisStudy study_diagnosis(const DiagnosisQuestion& question,
                                             const SelectionProgress& progress = {});

}  // namespace tethercalc
