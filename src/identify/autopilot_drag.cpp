#include "tethercalc/identify/autopilot_drag.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// What differs between autopilots.
struct Convention {
  std::string_view prefix;
  double largest_ballistic_coefficient = 0;  ///< kg/m², of the documented range
  double density_exponent = 0;               ///< of momentum drag: s = (ρ/ρ₀)^exponent
};

Convention convention_of(Autopilot autopilot) {
  return autopilot == Autopilot::ardupilot ? Convention{"EK3_DRAG_", 1000, 1}
                                           : Convention{"EKF2_", 200, 0.5};
}

constexpr double smallest_ballistic_coefficient = 1;  // kg/m²; up to here both take it as off
constexpr double smallest_momentum_drag = 0.001;      // 1/s, likewise
constexpr double largest_momentum_drag = 1;           // 1/s, of the documented ranges

/// Leaves a value out that the autopilot would refuse or take as "off".
void keep_in_range(AutopilotParameter& parameter, double least, double most) {
  const double value = parameter.value->value;
  if (value > least && value <= most) return;
  parameter.left_out_because = fmt::format("{:.4g} {} is outside its range, {:g} to {:g}", value,
                                           parameter.unit, least, most);
  parameter.value.reset();
}

/// Mass over an area that the fit has, the interval turned over with it.
AutopilotParameter ballistic_coefficient(const DragFit& fit, std::string name,
                                         const FittedParameter* area,
                                         const Convention& convention) {
  AutopilotParameter out{std::move(name), "kg/m²"};
  if (area == nullptr) {
    out.left_out_because =
        "these flights show no drag to the side, for they neither turn nor fly sideways enough";
    return out;
  }
  if (area->at_bound != Bound::none) {
    out.left_out_because = fmt::format("the fit holds {} at its bound", area->name);
    return out;
  }
  const Estimate& a = area->estimate;
  if (!(a.lower > 0)) {
    out.left_out_because = fmt::format("{} may be zero (95 % interval)", area->name);
    return out;
  }
  const double mass = fit.conditions.mass;
  const double slope = mass / (a.value * a.value);
  out.value = Estimate{mass / a.value,           slope * a.standard_error_independent,
                       slope * a.standard_error, a.degrees_of_freedom,
                       mass / a.upper,           mass / a.lower};
  keep_in_range(out, smallest_ballistic_coefficient, convention.largest_ballistic_coefficient);
  return out;
}

AutopilotParameter momentum_drag(const DragFit& fit, const Convention& convention) {
  AutopilotParameter out{fmt::format("{}MCOEF", convention.prefix), "1/s"};
  for (const FittedParameter* part : {&fit.front_area(), &fit.linear_speed()}) {
    if (part->at_bound == Bound::none) continue;
    out.left_out_because = fmt::format("the fit holds {} at its bound", part->name);
    return out;
  }
  const double area = fit.front_area().estimate.value;
  const double linear_speed = fit.linear_speed().estimate.value;
  const double density = fit.conditions.air_density;
  const double factor = 0.5 * density / fit.conditions.mass /
                        std::pow(density / standard_air_density, convention.density_exponent);
  std::vector<double> gradient(fit.parameters.size(), 0.0);
  gradient[0] = factor * linear_speed;  // by A_f
  gradient[2] = factor * area;          // by j
  out.value = propagate(fit, factor * area * linear_speed, gradient);
  if (!(out.value->lower > 0)) {
    out.value.reset();
    out.left_out_because = "drag in proportion to speed may be none (95 % interval)";
    return out;
  }
  keep_in_range(out, smallest_momentum_drag, largest_momentum_drag);
  return out;
}

/// Steady flight by both laws, each along the drone's forward axis, which sees the drag and the
/// airspeed at the cosine of the tilt.
std::optional<AutopilotDragCheck> checked(const DragFit& fit, const AutopilotDrag& drag,
                                          const Convention& convention) {
  std::optional<SteadyDrag> flight;
  for (double speed = std::floor(fit.max_airspeed); speed >= 1 && !flight; --speed) {
    flight = steady_drag(fit, speed);
  }
  if (!flight) return std::nullopt;
  const double density = fit.conditions.air_density;
  const double tilt = flight->tilt.value;
  const double along = flight->airspeed * std::cos(tilt);
  // PX4 multiplies by the magnitude of the airspeed, ArduPilot by its part along the axis.
  const double speed = drag.autopilot == Autopilot::px4 ? flight->airspeed : along;
  const auto& ballistic = drag.parameters[0].value;
  const auto& momentum = drag.parameters[2].value;
  const double by_autopilot =
      (ballistic ? 0.5 * density * along * speed / ballistic->value : 0) +
      (momentum ? momentum->value * along *
                      std::pow(density / standard_air_density, convention.density_exponent)
                : 0);
  return AutopilotDragCheck{flight->airspeed, tilt,
                            flight->force.value * std::cos(tilt) / fit.conditions.mass,
                            by_autopilot};
}

}  // namespace

AutopilotDrag autopilot_drag(const DragFit& fit, Autopilot autopilot) {
  const Convention convention = convention_of(autopilot);
  const auto named = [&](const char* name) { return fmt::format("{}{}", convention.prefix, name); };
  AutopilotDrag out{autopilot, {}, {}};
  out.parameters.push_back(
      ballistic_coefficient(fit, named("BCOEF_X"), &fit.front_area(), convention));
  out.parameters.push_back(
      ballistic_coefficient(fit, named("BCOEF_Y"), fit.find("side_area_m2"), convention));
  out.parameters.push_back(momentum_drag(fit, convention));
  out.check = checked(fit, out, convention);
  return out;
}

}  // namespace tethercalc
