#include "diagnose/tilt_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

/// As for the power of what was flown: at 80° the thrust is six times the weight.
constexpr double steepest_tan = 6;

/// Error of the drag over mass that is the same in all blocks, so that their spread does not show
/// it: a standard deviation, relative. An autopilot that leans against gusts makes the drag of
/// simulated flights come out 2.2 % too large in the mean (docs/diagnosis-power.md).
constexpr double common_error = 0.02;

/// Of the drag over mass, the half width of its 95 % interval beyond which the tilt tells it no
/// better than a guess by the mass does, which may be off by a factor of two.
constexpr double most_uncertain = 0.5;

/// Height where the drag shows, which grows with the square of the airspeed.
double height_of_drag(const PowerLog& log) {
  if (log.height.empty() || log.airspeed.empty()) return 0;
  double sum = 0;
  double weights = 0;
  double mean = 0;
  for (std::size_t i = 0; i < log.height.size(); ++i) {
    const double weight = log.airspeed[i] * log.airspeed[i];
    sum += weight * log.height[i];
    weights += weight;
    mean += log.height[i] / static_cast<double>(log.height.size());
  }
  return weights > 0 ? sum / weights : mean;
}

}  // namespace

double drag_over_mass(const AirframeDrag& law, double mass, double air_density, double gravity,
                      std::span<const double> airspeed) {
  double sum = 0;
  for (const double v : airspeed) {
    const ForceBalance balance{mass * gravity, area_force_factor(law, air_density, v), 0,
                               law.front_area, law.top_area};
    sum += gravity * equilibrium_tan_pitch(balance, steepest_tan);
  }
  return sum / static_cast<double>(airspeed.size());
}

MeanAndError mean_drag_over_mass(const DragByTilt& shown) {
  const std::vector<double>& x = shown.over_mass;
  const auto n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  double sum = 0;
  for (const double value : x) sum += (value - mean) * (value - mean);
  return {mean, std::sqrt(sum / (n - 1) / n)};
}

std::optional<TiltComparison> TiltComparison::of(const DragByTilt& shown, const PowerModel& base,
                                                 const PowerLog& log,
                                                 double false_alarm_probability,
                                                 std::vector<Warning>& notes) {
  TiltComparison tilt(shown, height_of_drag(log), log.free_flight);
  const auto blocks = static_cast<double>(shown.over_mass.size());
  const auto [mean, error] = mean_drag_over_mass(shown);
  tilt.mean_ = mean;
  const double common = common_error * std::abs(tilt.mean_);
  constexpr double normal_95 = 1.96;
  tilt.half_width_ = std::hypot(student_quantile(blocks - 1, 0.975) * error, normal_95 * common);
  // The spread is known from few blocks: rows as wide as Student's tails have the normal ones.
  constexpr double many = 1e6;
  const double tails = student_quantile(blocks - 1, false_alarm_probability / 2) /
                       student_quantile(many, false_alarm_probability / 2);
  tilt.noise_ = std::hypot(tails * error, common) * std::sqrt(blocks);
  const double least_known = most_uncertain * std::min(tilt.mean_, tilt.predicted(base));
  if (!(error > 0) || !std::isfinite(tilt.mean_) || !(tilt.half_width_ < least_known)) {
    notes.push_back(
        {WarningKind::tilt_tells_nothing,
         "the tilt tells the drag of this drone no better than a guess does, so it does not say "
         "whether the drone is "
         "heavier or its motors are hungrier, and the design keeps its drag: that takes passes at "
         "speed, there and back"});
    return std::nullopt;
  }
  return tilt;
}

double TiltComparison::predicted(const PowerModel& model) const {
  std::optional<Design> freed;
  if (free_flight_) freed = without_tether(model.design);
  const Design& design = freed ? *freed : model.design;
  const double height = std::max(0.0, height_ - model.instruments.height_offset);
  const double deployed = free_flight_ ? 0 : (1 + model.slack) * height;
  FlownDesign flown(design, loads_);
  double sum = 0;
  for (const double v : shown_.airspeed) {
    const bool hangs = flown.in(flight_state_at(design, deployed, v)) != nullptr;
    sum += design.flight.gravity * (hangs ? flown.tan_pitch(steepest_tan) : infinity);
  }
  return sum / static_cast<double>(shown_.airspeed.size());
}

void TiltComparison::whitened(const PowerModel& model, std::span<double> out) const {
  const double here = predicted(model);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (shown_.over_mass[i] - here) / noise_;
}

AirframeDrag TiltComparison::drag_of(const PowerModel& model) const {
  PowerModel leaning = model;
  const auto with_areas = [&](double scale) {
    leaning.design.drone.drag = shown_.law;
    leaning.design.drone.drag.front_area *= scale;
    leaning.design.drone.drag.top_area *= scale;
    return predicted(leaning);
  };
  const double tether_alone = with_areas(0);
  double scale = 1;
  // Nearly linear in the areas: each step gains three digits.
  for (int i = 0; i < 6; ++i) {
    const double airframe = with_areas(scale) - tether_alone;
    if (!(mean_ > tether_alone) || !(airframe > 0)) return model.design.drone.drag;
    scale *= (mean_ - tether_alone) / airframe;
  }
  with_areas(scale);
  return leaning.design.drone.drag;
}

}  // namespace tethercalc
