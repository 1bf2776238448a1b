// The step-down converter on the drone, between the tether and the motors.
#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace tethercalc {

/// Efficiency of a converter at one load.
struct EfficiencyPoint {
  double output_power = 0;  ///< W, ≥ 0
  double efficiency = 1;    ///< in (0, 1]
};

/// What one converter of a family weighs.
struct ConverterMassPoint {
  double rated_output_power = 0;  ///< W, > 0
  double mass = 0;                ///< kg, ≥ 0
};

/// A converter by its losses: input = output + fixed + square·output². The fixed part drives the
/// switches, the square one heats the windings (Erickson and Maksimović, Fundamentals of Power
/// Electronics, 3rd ed., section 4.3).
struct ConverterLosses {
  double fixed = 0;   ///< W, ≥ 0
  double square = 0;  ///< 1/W, ≥ 0

  /// W that are lost at `output` W.
  [[nodiscard]] double at(double output) const { return fixed + square * output * output; }
};

/// A converter by its efficiency over load and the input voltage at which it cuts off.
///
/// Efficiency is linear between the points and constant outside them; a single point is a constant
/// efficiency. On a piece η = a + b·P the input P/η rises with the output wherever a > 0, which
/// `validate` demands, so input and output determine each other.
struct Converter {
  std::vector<EfficiencyPoint> efficiency{{0.0, 1.0}};  ///< by rising output power, never empty
  double min_input_voltage = 0;                         ///< V, the cut-off U_minDC of the paper

  std::optional<double> max_input_voltage{};   ///< V, the most it stands
  std::optional<double> rated_output_power{};  ///< W, the most it gives continuously
  double specific_mass = 0;                    ///< kg per W of rated output
  std::vector<ConverterMassPoint> masses{};    ///< by rising power; where given, instead of that
  std::optional<double> fixed_ratio{};  ///< output over input voltage, where that does not vary
  double min_output_voltage = 0;        ///< V that the motors need of a fixed-ratio converter

  ConverterLosses losses{};  ///< take the place of the efficiency where they are not both 0
};

/// Mass in kg for the rated output: from the table `masses`, linear between its points, that of the
/// first below it (nothing smaller is sold), that of the last in proportion above it (several of
/// them); without a table specific mass times rated output. 0 where no rated output is stated.
[[nodiscard]] double converter_mass(const Converter& converter);

/// Input voltage in V below which the converter does not serve: its cut-off, or where its ratio is
/// fixed, the output following the input, the voltage at which the output sinks to what the motors
/// need, if that is higher.
[[nodiscard]] double lowest_input_voltage(const Converter& converter);

/// Throws std::invalid_argument where the curve is empty, not by strictly rising output power, has
/// an efficiency outside (0, 1], or would draw less power at a higher load.
void validate(const Converter& converter);

/// Throws std::invalid_argument where `masses` is not by strictly rising power, or falls with it.
void validate(const std::vector<ConverterMassPoint>& masses);

/// Output voltage in V at `input_voltage` V of a converter of fixed ratio; NaN for others, which
/// regulate it.
[[nodiscard]] double converter_output_voltage(const Converter& converter, double input_voltage);

/// Whether the converter is known by its losses.
[[nodiscard]] inline bool has_losses(const Converter& converter) {
  return converter.losses.fixed > 0 || converter.losses.square > 0;
}

/// Whether its input is proportional to its output.
[[nodiscard]] inline bool is_proportional(const Converter& converter) {
  return converter.efficiency.size() == 1 && !has_losses(converter);
}

/// Efficiency at `output_power` in W (≥ 0).
[[nodiscard]] double efficiency_at(const Converter& converter, double output_power);

/// Input power in W that yields `output_power` in W, where the converter has losses.
[[nodiscard]] inline double input_with_losses(const ConverterLosses& losses, double output_power) {
  // 0·∞ has no value.
  return output_power < std::numeric_limits<double>::infinity()
             ? output_power + losses.at(output_power)
             : output_power;
}

/// Input power in W that yields `output_power` in W (≥ 0). +infinity stays +infinity.
[[nodiscard]] inline double converter_input_power(const Converter& converter, double output_power) {
  if (is_proportional(converter)) return output_power / converter.efficiency[0].efficiency;
  return has_losses(converter) ? input_with_losses(converter.losses, output_power)
                               : output_power / efficiency_at(converter, output_power);
}

/// Efficiency η = offset + slope·P_out on one piece of the curve, or the losses.
struct EfficiencyPiece {
  double offset = 1;         ///< of a load of 0
  double slope = 0;          ///< 1/W
  ConverterLosses losses{};  ///< beside what the efficiency loses

  /// Input power in W for `output` W.
  [[nodiscard]] double input_power(double output) const {
    return output / (offset + slope * output) + losses.at(output);
  }
  /// Its derivative.
  [[nodiscard]] double input_slope(double output) const {
    const double efficiency = offset + slope * output;
    return offset / (efficiency * efficiency) + 2 * losses.square * output;
  }
};

/// The piece that holds `output_power`.
[[nodiscard]] EfficiencyPiece efficiency_piece(const Converter& converter, double output_power);

/// Output power in W made of `input_power` in W: the inverse of `converter_input_power`. 0 where
/// that is not more than the converter takes for itself.
[[nodiscard]] double converter_output_power(const Converter& converter, double input_power);

}  // namespace tethercalc
