#include "tethercalc/model/converter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tethercalc {
namespace {

/// Efficiency η = offset + slope·P_out of one piece of the curve.
struct EfficiencyPiece {
  double offset = 1;
  double slope = 0;
};

EfficiencyPiece between(const EfficiencyPoint& a, const EfficiencyPoint& b) {
  const double slope = (b.efficiency - a.efficiency) / (b.output_power - a.output_power);
  return {a.efficiency - slope * a.output_power, slope};
}

double input_at(const EfficiencyPoint& point) { return point.output_power / point.efficiency; }

/// The piece for a load, found by comparing `value` with `measure(point)`, which rises along the
/// curve.
template <typename Measure>
EfficiencyPiece piece_at(const Converter& converter, double value, Measure measure) {
  const auto& points = converter.efficiency;
  if (!(value > measure(points.front()))) return {points.front().efficiency, 0};
  if (value >= measure(points.back())) return {points.back().efficiency, 0};
  const auto above =
      std::upper_bound(points.begin(), points.end(), value,
                       [&](double v, const EfficiencyPoint& point) { return v < measure(point); });
  return between(*(above - 1), *above);
}

}  // namespace

void validate(const Converter& converter) {
  const auto& points = converter.efficiency;
  if (points.empty()) throw std::invalid_argument("a converter needs at least one efficiency");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = "efficiency point " + std::to_string(i + 1);
    if (!(points[i].efficiency > 0 && points[i].efficiency <= 1)) {
      throw std::invalid_argument(name + " is outside (0, 1]");
    }
    if (!(points[i].output_power >= 0 && std::isfinite(points[i].output_power))) {
      throw std::invalid_argument(name + " has a negative or infinite output power");
    }
    if (i == 0) continue;
    if (!(points[i].output_power > points[i - 1].output_power)) {
      throw std::invalid_argument(name +
                                  " does not have a higher output power than the one before");
    }
    if (!(between(points[i - 1], points[i]).offset > 0)) {
      throw std::invalid_argument(name + " would draw less input power than the one before");
    }
  }
}

double converter_mass(const Converter& converter) {
  return converter.specific_mass * converter.rated_output_power.value_or(0);
}

double lowest_input_voltage(const Converter& converter) {
  if (!converter.fixed_ratio) return converter.min_input_voltage;
  return std::max(converter.min_input_voltage,
                  converter.min_output_voltage / *converter.fixed_ratio);
}

double efficiency_at(const Converter& converter, double output_power) {
  const EfficiencyPiece piece =
      piece_at(converter, output_power, [](const EfficiencyPoint& p) { return p.output_power; });
  return piece.slope == 0 ? piece.offset : piece.offset + piece.slope * output_power;
}

double converter_output_power(const Converter& converter, double input_power) {
  if (!(input_power > 0)) return 0;
  if (converter.efficiency.size() == 1) return input_power * converter.efficiency[0].efficiency;
  const EfficiencyPiece piece = piece_at(converter, input_power, input_at);
  // P_in = P_out/(offset + slope·P_out), solved for P_out.
  return piece.offset * input_power / (1 - piece.slope * input_power);
}

}  // namespace tethercalc
