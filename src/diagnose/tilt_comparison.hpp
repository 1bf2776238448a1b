// The drag over mass that a flight's tilt shows, as one more comparison of a power log's model.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnose/power_chain.hpp"
#include "tethercalc/diagnose/drag_by_tilt.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// Mean over `airspeed` (m/s) of g·tan θ in m/s², θ being the tilt at which a drone of `mass` kg
/// without a tether holds that airspeed.
[[nodiscard]] double drag_over_mass(const AirframeDrag& law, double mass, double air_density,
                                    double gravity, std::span<const double> airspeed);

/// What blocks that tell it alike come to.
struct MeanAndError {
  double mean = 0;
  double error = 0;  ///< standard error of the mean
};
/// Of the drag over mass that a flight shows, m/s².
[[nodiscard]] MeanAndError mean_drag_over_mass(const DragByTilt& shown);

/// Rows of independent noise of size 1, as those of `PowerResiduals`.
class TiltComparison {
 public:
  static constexpr const char* quantity = "drag over mass that the tilt shows";
  static constexpr const char* unit = "m/s²";

  /// What `shown` comes to for a drone that flies as high as `log`, with `false_alarm_probability`
  /// the chance that one row's noise may pass for an effect. Nothing where the flight tells
  /// the drag no better than a guess does, which is then noted.
  static std::optional<TiltComparison> of(const DragByTilt& shown, const PowerModel& base,
                                          const PowerLog& log, double false_alarm_probability,
                                          std::vector<Warning>& notes);

  [[nodiscard]] std::size_t rows() const { return shown_.over_mass.size(); }
  [[nodiscard]] const DragByTilt& shown() const { return shown_; }
  /// m/s², the mean of the rows.
  [[nodiscard]] double mean() const { return mean_; }
  /// m/s², of the 95 % confidence interval of the mean.
  [[nodiscard]] double half_width() const { return half_width_; }
  /// m/s², what the model makes of the flight.
  [[nodiscard]] double predicted(const PowerModel& model) const;
  /// Shown less predicted over the noise, one element a row.
  void whitened(const PowerModel& model, std::span<double> out) const;

  /// The flight's law of drag with areas that make the model lean as the flight did; the model's
  /// own drag where the tether alone leans it further.
  [[nodiscard]] AirframeDrag drag_of(const PowerModel& model) const;

 private:
  TiltComparison(DragByTilt shown, double height, bool free_flight)
      : shown_(std::move(shown)), height_(height), free_flight_(free_flight) {}

  DragByTilt shown_;
  double height_;     ///< m, as read where the drag showed
  bool free_flight_;  ///< without a tether
  double mean_ = 0;   ///< m/s²
  double half_width_ = 0;
  double noise_ = 1;  ///< m/s², of one row
  mutable HangingLoads loads_;
};

}  // namespace tethercalc
