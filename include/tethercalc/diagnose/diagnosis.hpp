// What a diagnosis says: findings with their gain, what could not be tested, what stays
// unexplained.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/drag_by_tilt.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// Every default is a choice; the comment says what it trades.
struct SelectionOptions {
  /// Chance of naming anything at all where nothing is hidden, over the whole catalogue and all
  /// steps (Bonferroni–Holm over the candidates that are tested).
  double false_alarm_probability = 0.01;

  /// Smallest drop of held-out rmse worth a name, in percent. Below it a statistically certain
  /// gain may as well come from the imperfection of the log (time stamps, filters, sampling).
  double least_gain_percent = 2.0;

  /// The same for unnamed structure, in percent of the held-out rmse left.
  double least_unexplained_percent = 2.0;

  /// At most this many effects are named.
  std::size_t most_findings = 6;
};

/// Told after each fit what is being done, in words; for a progress display.
using SelectionProgress = std::function<void(const std::string&)>;

/// Fewer blocks than this give no usable spread: a t quantile with 5 degrees of freedom is already
/// 30 % wider than the normal one.
inline constexpr std::size_t fewest_blocks = 6;

/// A fitted parameter in the unit a person reads it in.
struct ParameterEstimate {
  std::string name;       ///< as in the catalogue, its unit included
  double value = 0;       ///< of the best fit
  std::string unit;       ///< "1" for a plain number
  double ci95_lower = 0;  ///< 95 % confidence interval, same unit, from the spread over blocks
  double ci95_upper = 0;  ///< the other end
  /// 1, 2, …: the flight that it belongs to, of several that are judged together; 0: to all, as
  /// always where there is one log. So below.
  std::size_t flight = 0;
};

/// One named cause.
struct Finding {
  std::string effect;                         ///< id in the catalogue
  std::string title;                          ///< what a person calls it
  std::string mechanism;                      ///< one sentence
  std::string stage;                          ///< supply, tether, converter, motors or airframe
  std::vector<ParameterEstimate> parameters;  ///< of the final, joint fit
  double holdout_rmse_before = 0;             ///< with the findings before it in place
  double holdout_rmse_after = 0;  ///< with it as well, everything free refitted together
  double gain_percent = 0;        ///< 100·(1 − after/before)
  double gain_se_percent = 0;     ///< standard error over blocks
  /// Ids of effects that explain this log as well; with the flight, as in "wind (flight 2)", where
  /// they act in one of several.
  std::vector<std::string> indistinguishable_from;
  std::string to_separate;  ///< the flight or channel that would tell them apart; may be empty
  std::size_t flight = 0;   ///< the only one that it acts in
};

/// An effect that chance hardly explains, and that is not certain or not large enough to be named.
struct Suspected {
  std::string effect;                         ///< id in the catalogue
  std::string title;                          ///< what a person calls it
  double gain_percent = 0;                    ///< on data not fitted, were it in the model
  double gain_se_percent = 0;                 ///< standard error over blocks
  std::vector<ParameterEstimate> parameters;  ///< its sizes, beside the findings
  std::string missing;                        ///< what it takes to be sure
  std::size_t flight = 0;                     ///< the only one that it acts in
  /// Of findings what they would be with it at work too, where that is beyond their intervals.
  std::vector<ParameterEstimate> findings_with_it{};
};

/// The largest size of an effect, alone beside the findings, that this log still allows: more would
/// have shown. Two that cancel may both be larger.
struct RuledOut {
  std::string effect;     ///< id in the catalogue
  std::string parameter;  ///< of it
  double bound = 0;  ///< distance from neutral, the further end of the 95 % confidence interval
  std::string unit;  ///< of the bound; "1" for a plain number
  std::size_t flight = 0;  ///< the only one that it acts in
};

/// An effect that this log says nothing about.
struct NotTestable {
  std::string effect;      ///< id in the catalogue
  std::string needs;       ///< the channel, or the kind of log
  std::size_t flight = 0;  ///< the only one that it acts in
};

/// An effect that no log of this kind, or this one, can tell from the base model.
struct NotIdentifiable {
  std::string effect;      ///< id in the catalogue
  std::string because;     ///< what takes its place
  std::size_t flight = 0;  ///< the only one that it acts in
};

/// Structure that no effect of the catalogue explains.
struct Unexplained {
  bool detected = false;              ///< whether it beats chance and is worth a word
  std::vector<std::string> channels;  ///< the one it follows most closely first
  double share_percent = 0;           ///< part of the remaining held-out squared error it makes up
  /// Structure of a smaller part of that error would not have shown in a log with so few
  /// independent samples. 100 where none were looked for.
  double undetectable_percent = 100;
  double size = 0;        ///< of a flight the root mean square of what follows it; of a power log
                          ///< the height of the step, or the amplitude, of the strongest
  std::string size_unit;  ///< "m/s²"; of a power log "ohm", "W" or "%", by stage
  std::string shape;      ///< plain words; empty where nothing was detected
  std::string regressor;  ///< the one that captures it best
  /// The same as a `Hypothesis` has it, with a parameter c: a force in N, or a power in W. Empty
  /// where it is neither, as a resistance.
  std::string formula;
  double coefficient = 0;  ///< c

  /// Whether what is left may be called noise. A structure of a tenth of it makes its rms 5 %
  /// larger than the noise's.
  [[nodiscard]] bool would_have_shown() const { return undetectable_percent <= 10; }
};

/// A model fitted to the log, judged on data it was not fitted to.
struct ModelQuality {
  double holdout_rmse = 0;  ///< in `Diagnosis::unit`; NaN where the log is too short to hold out
  std::vector<ParameterEstimate> parameters;  ///< all that were fitted
};

/// The same held-out comparison for a further quantity of the log, such as the speed simulated in
/// open loop. Reported beside the deciding one; it decides nothing.
struct HoldoutComparison {
  std::string quantity;      ///< in words
  std::string unit;          ///< of both errors
  double base_rmse = 0;      ///< of the base model
  double extended_rmse = 0;  ///< with the findings
  /// Mean held-out prediction over mean measurement, in a power log; NaN elsewhere.
  double base_mean_ratio = std::numeric_limits<double>::quiet_NaN();
  /// The same with the findings.
  double extended_mean_ratio = std::numeric_limits<double>::quiet_NaN();
};

/// How much of the base model's held-out squared error has which origin, in percent. The parts of
/// the findings, in their order, then what is unexplained and what is noise; they sum to 100.
struct ErrorBudget {
  std::vector<double> findings;  ///< percent each
  double unexplained = 0;        ///< percent
  double noise = 0;              ///< percent
};

/// A number of the design before and after the extension. Empty where the optimum does not exist.
struct BeforeAfter {
  std::optional<double> before;  ///< by the spec as it stands
  std::optional<double> after;   ///< by the extended spec
};

/// How the findings move the best design.
struct DesignImpact {
  BeforeAfter cross_section_mm2;  ///< optimum of one conductor
  BeforeAfter total_power_W;      ///< from the supply, at that optimum
};

/// A field of the design spec that the extended model fills.
struct SpecChange {
  std::string field;  ///< path in the spec, such as "drone.drag.linear_m_s"
  double value = 0;   ///< in the unit of the field's name
};

/// One quantity that was compared, sample by sample, as the instruments show it. Predictions are
/// held out: each sample's comes from fits without its block. NaN where a sample was left out.
struct ComparedSeries {
  std::string quantity;          ///< in words: "forward acceleration"
  std::string unit;              ///< of the values
  std::string stage;             ///< as in `Finding::stage`
  std::vector<double> time;      ///< s, the log's clock
  std::vector<double> measured;  ///< what was read
  std::vector<double> before;    ///< predicted by the base model
  std::vector<double> after;     ///< predicted with the findings
};

/// A channel of a log, or what two of them make together.
struct Channel {
  std::string name;            ///< in words: "forward speed"
  std::string unit;            ///< of the values
  std::vector<double> values;  ///< one a sample
};

/// Where a finding shows: what is left of the measurement, in the unit of the compared series, if
/// only this finding is taken out of the final fit, and with it in.
struct FindingTrace {
  std::size_t series = 0;       ///< into `Diagnosis::compared`, the first that the finding acts on
  Channel channel;              ///< that the effect acts through, see `Effect::channel`
  std::vector<double> without;  ///< measured less predicted, NaN where a sample was left out
  std::vector<double> with;     ///< likewise
};

/// All that is said of one log.
struct Diagnosis {
  LogKind kind = LogKind::flight;                 ///< which log it is of
  std::size_t samples = 0;                        ///< used
  double effective_samples = 0;                   ///< as many independent ones would weigh as much;
                                                  ///< of a power log the mean over its comparisons
  std::string unit;                               ///< of every held-out error
  std::string quantity;                           ///< in words: what is predicted and compared
  ModelQuality base;                              ///< without any finding
  std::vector<Finding> findings;                  ///< in the order they were found
  std::vector<Suspected> suspected;               ///< beside the findings
  std::vector<RuledOut> ruled_out;                ///< beside the findings, one a size
  std::vector<NotTestable> not_testable;          ///< for want of a channel, of length or of motion
  std::vector<NotIdentifiable> not_identifiable;  ///< whatever the channels
  Unexplained unexplained;                        ///< beside the findings
  ModelQuality extended;                          ///< with all findings
  std::vector<SpecChange> spec_changes;           ///< turn the spec into the extended one
  ErrorBudget budget;                             ///< of the base model
  std::vector<HoldoutComparison> further;         ///< quantities that decide nothing
  std::vector<Warning> notes;  ///< what was done to the log: samples left out and why
  std::optional<DesignImpact> design_impact;  ///< where it was asked for
  std::vector<ComparedSeries> compared;       ///< for pictures: one a stage of the chain
  std::vector<FindingTrace> traces;           ///< for pictures: one a finding
  std::optional<DragByTilt>
      drag_by_tilt;  ///< of flights; of a power log where it was compared, too
};

}  // namespace tethercalc
