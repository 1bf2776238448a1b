// The step-down converter on the drone, between the tether and the motors.
#pragma once

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

/// Efficiency at `output_power` in W (≥ 0).
[[nodiscard]] double efficiency_at(const Converter& converter, double output_power);

/// Input power in W that yields `output_power` in W (≥ 0). +infinity stays +infinity.
[[nodiscard]] inline double converter_input_power(const Converter& converter, double output_power) {
  return output_power / (converter.efficiency.size() == 1 ? converter.efficiency[0].efficiency
                                                          : efficiency_at(converter, output_power));
}

/// Efficiency η = offset + slope·P_out on one piece of the curve.
struct EfficiencyPiece {
  double offset = 1;  ///< of a load of 0
  double slope = 0;   ///< 1/W

  /// Input power in W for `output` W.
  [[nodiscard]] double input_power(double output) const {
    return output / (offset + slope * output);
  }
  /// Its derivative.
  [[nodiscard]] double input_slope(double output) const {
    const double efficiency = offset + slope * output;
    return offset / (efficiency * efficiency);
  }
};

/// The piece that holds `output_power`.
[[nodiscard]] EfficiencyPiece efficiency_piece(const Converter& converter, double output_power);

/// Output power in W made of `input_power` in W: the inverse of `converter_input_power`. 0 where
/// input_power ≤ 0.
[[nodiscard]] double converter_output_power(const Converter& converter, double input_power);

}  // namespace tethercalc
