// An effect that is in no catalogue: somebody's own idea of what moves a drone or draws its power,
// tried by a diagnosis like the effects of the catalogue.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"

namespace tethercalc {

/// What a formula may use of a sample of a log, or of the design.
struct FormulaChannel {
  std::string_view name;  ///< as in formulas
  std::string_view unit;  ///< SI
  std::string_view help;  ///< what it is
};

/// The channels of such logs, in the order in which a formula gets them. What is to be explained
/// (the acceleration, the power at the bus) is not among them.
[[nodiscard]] std::span<const FormulaChannel> formula_channels(LogKind kind);

/// An idea and its formula.
struct Hypothesis {
  std::string id{};                           ///< unlike those of the catalogue
  std::string title{};                        ///< what a person calls it
  std::string mechanism{};                    ///< one sentence
  std::string to_separate{};                  ///< what flight would tell it from its like
  LogKind log = LogKind::flight;              ///< which log can show it
  std::vector<EffectParameter> parameters{};  ///< name, unit, neutral, lower, upper and scale
  /// The force in N that pushes the drone forward, of a flight; the power in W drawn at the bus
  /// beyond the prediction, of a power log. Of the channels and the parameters in their units, each
  /// in its order. Zero at neutral values.
  std::function<double(std::span<const double> channels, std::span<const double> parameters)>
      formula{};
  std::string words{};  ///< the formula as a person wrote it
};

/// The hypothesis as an effect: held to the same hold-out and false-alarm control as any. A
/// parameter that changes nothing while all others are neutral is the shape of the others.
///
/// Throws std::invalid_argument where the id is one of the catalogue, where there is no parameter,
/// bounds do not enclose the neutral value, or a scale is not positive; where the formula is no
/// number or not zero at neutral values, and where no parameter changes it by itself. The effect
/// throws it, too, where the formula is no number in a sample of the log.
[[nodiscard]] Effect effect_of(const Hypothesis& hypothesis);

/// Those of the catalogue and of `hypotheses` that such logs can show. `hypotheses` must outlive
/// the result.
[[nodiscard]] std::vector<const Effect*> effects_for(LogKind kind,
                                                     std::span<const Effect> hypotheses);

}  // namespace tethercalc
