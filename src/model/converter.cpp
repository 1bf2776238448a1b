#include "tethercalc/model/converter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

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
  const auto above = std::ranges::upper_bound(points, value, {}, measure);
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

void validate(const std::vector<ConverterMassPoint>& masses) {
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const std::string name = "converter " + std::to_string(i + 1);
    if (!(masses[i].rated_output_power > 0 && masses[i].mass >= 0)) {
      throw std::invalid_argument(name +
                                  " has a rated output that is not positive or a negative "
                                  "mass");
    }
    if (i == 0) continue;
    if (!(masses[i].rated_output_power > masses[i - 1].rated_output_power)) {
      throw std::invalid_argument(name +
                                  " does not have a higher rated output than the one before");
    }
    if (!(masses[i].mass >= masses[i - 1].mass)) {
      throw std::invalid_argument(name + " is lighter than the one before");
    }
  }
}

double converter_mass(const Converter& converter) {
  const double rated = converter.rated_output_power.value_or(0);
  const auto& masses = converter.masses;
  if (masses.empty() || rated == 0) return converter.specific_mass * rated;
  if (rated <= masses.front().rated_output_power) return masses.front().mass;
  const ConverterMassPoint& last = masses.back();
  if (rated >= last.rated_output_power) return last.mass * (rated / last.rated_output_power);
  const auto above =
      std::ranges::upper_bound(masses, rated, {}, &ConverterMassPoint::rated_output_power);
  const ConverterMassPoint& a = *(above - 1);
  return a.mass + (above->mass - a.mass) * (rated - a.rated_output_power) /
                      (above->rated_output_power - a.rated_output_power);
}

double converter_output_voltage(const Converter& converter, double input_voltage) {
  return converter.fixed_ratio ? *converter.fixed_ratio * input_voltage : nan;
}

double lowest_input_voltage(const Converter& converter) {
  if (!converter.fixed_ratio) return converter.min_input_voltage;
  return std::max(converter.min_input_voltage,
                  converter.min_output_voltage / *converter.fixed_ratio);
}

EfficiencyPiece efficiency_piece(const Converter& converter, double output_power) {
  if (has_losses(converter)) return {1, 0, converter.losses};
  return piece_at(converter, output_power, [](const EfficiencyPoint& p) { return p.output_power; });
}

double efficiency_at(const Converter& converter, double output_power) {
  if (has_losses(converter)) {
    return output_power / input_with_losses(converter.losses, output_power);
  }
  const EfficiencyPiece piece = efficiency_piece(converter, output_power);
  return piece.slope == 0 ? piece.offset : piece.offset + piece.slope * output_power;
}

double converter_output_power(const Converter& converter, double input_power) {
  if (!(input_power > converter.losses.fixed)) return 0;
  if (has_losses(converter)) {
    const double rest = input_power - converter.losses.fixed;
    return 2 * rest / (1 + std::sqrt(1 + 4 * converter.losses.square * rest));
  }
  if (converter.efficiency.size() == 1) return input_power * converter.efficiency[0].efficiency;
  const EfficiencyPiece piece = piece_at(converter, input_power, input_at);
  // P_in = P_out/(offset + slope·P_out), solved for P_out.
  return piece.offset * input_power / (1 - piece.slope * input_power);
}

}  // namespace tethercalc
