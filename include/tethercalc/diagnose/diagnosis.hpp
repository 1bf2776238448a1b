// What a diagnosis says: findings with their gain, what could not be tested, what stays
// unexplained.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tethercalc {

/// A fitted parameter in the unit a person reads it in.
struct ParameterEstimate {
  std::string name;
  double value = 0;
  std::string unit;
  double ci95_lower = 0;  ///< 95 % confidence interval, same unit, from the spread over blocks
  double ci95_upper = 0;
};

/// One named cause.
struct Finding {
  std::string effect;  ///< id in the catalogue
  std::string title;
  std::string mechanism;                      ///< one sentence
  std::string stage;                          ///< supply, tether, converter, motors or airframe
  std::vector<ParameterEstimate> parameters;  ///< of the final, joint fit
  double holdout_rmse_before = 0;             ///< with the findings before it in place
  double holdout_rmse_after = 0;  ///< with it as well, everything free refitted together
  double gain_percent = 0;        ///< 100·(1 − after/before)
  double gain_se_percent = 0;     ///< standard error over blocks
  std::vector<std::string> indistinguishable_from;  ///< ids that explain this log as well
  std::string to_separate;  ///< the flight or channel that would tell them apart; may be empty
};

struct NotTestable {
  std::string effect;
  std::string needs;  ///< the channel, or the kind of log
};

struct NotIdentifiable {
  std::string effect;
  std::string because;
};

/// Structure that no effect of the catalogue explains.
struct Unexplained {
  bool detected = false;
  std::vector<std::string> channels;  ///< the one it follows most closely first
  double share_percent = 0;           ///< part of the remaining held-out squared error it makes up
  std::string shape;                  ///< plain words; empty where nothing was detected
  std::string regressor;              ///< the one that captures it best
};

/// A model fitted to the log, judged on data it was not fitted to.
struct ModelQuality {
  double holdout_rmse = 0;  ///< in `Diagnosis::unit`; NaN where the log is too short to hold out
  std::vector<ParameterEstimate> parameters;
};

/// The same held-out comparison for a further quantity of the log, such as the speed simulated in
/// open loop. Reported beside the deciding one; it decides nothing.
struct HoldoutComparison {
  std::string quantity;
  std::string unit;
  double base_rmse = 0;
  double extended_rmse = 0;
};

/// How much of the base model's held-out squared error has which origin, in percent. The parts of
/// the findings, in their order, then what is unexplained and what is noise; they sum to 100.
struct ErrorBudget {
  std::vector<double> findings;
  double unexplained = 0;
  double noise = 0;
};

/// A number of the design before and after the extension. Empty where the optimum does not exist.
struct BeforeAfter {
  std::optional<double> before;
  std::optional<double> after;
};

struct DesignImpact {
  BeforeAfter cross_section_mm2;
  BeforeAfter total_power_W;
};

/// A field of the design spec that the extended model fills.
struct SpecChange {
  std::string field;  ///< path in the spec, such as "drone.drag.linear_m_s"
  double value = 0;   ///< in the unit of the field's name
};

struct Diagnosis {
  std::string kind;              ///< "flight" or "power"
  std::size_t samples = 0;       ///< used
  double effective_samples = 0;  ///< as many independent ones would weigh as much
  std::string unit;              ///< of every held-out error
  std::string quantity;          ///< in words: what is predicted and compared
  ModelQuality base;
  std::vector<Finding> findings;  ///< in the order they were found
  std::vector<NotTestable> not_testable;
  std::vector<NotIdentifiable> not_identifiable;
  Unexplained unexplained;
  ModelQuality extended;
  std::vector<SpecChange> spec_changes;  ///< turn the spec into the extended one
  ErrorBudget budget;
  std::vector<HoldoutComparison> further;
  std::vector<std::string> notes;  ///< what was done to the log: samples left out and why
  std::optional<DesignImpact> design_impact;
};

}  // namespace tethercalc
