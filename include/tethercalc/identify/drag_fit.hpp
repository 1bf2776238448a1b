// The drone's drag, learned from its own flights, with errors that hold for correlated residuals.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/airframe.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// What a fit takes as known.
struct DragFitConditions {
  double mass = 0;             ///< kg, > 0, of the drone as flown. A wrong mass rescales both areas
  double air_density = 1.293;  ///< kg/m³, > 0. A wrong density rescales both areas inversely
  double gravity = standard_gravity;  ///< m/s², > 0, the value the observations were made with
};

/// The box the parameters are kept in; areas and j are never negative. Wide enough that no
/// multirotor reaches it; a parameter found at its bound says that the data lacks something.
struct DragBounds {
  double max_linear_speed = 500;  ///< m/s: at 25 m/s the quadratic part is then 5 % of the drag
  double max_wind = 30;           ///< m/s either way
};

/// The parameters of the paper's drag model, F_D = ½·ρ·(A_f cos|θ| + A_t sin|θ|)(u|u| + j·u) with
/// u = v − w.
struct DragParameters {
  double front_area = 0;     ///< A_f, m²
  double top_area = 0;       ///< A_t, m²
  double linear_speed = 0;   ///< j, m/s
  std::vector<double> wind;  ///< w, m/s, one a flight: motion of the air along the forward axis
};

/// How to fit; the defaults are right for a flight.
struct DragFitOptions {
  DragBounds bounds;  ///< the box the parameters are kept in

  /// Where to start instead of at the best point of the search grid. The result does not depend on
  /// it wherever the fit converges; it is here so that this can be checked. `wind` one a flight.
  std::optional<DragParameters> start;
};

/// A number with its uncertainty, all in the unit of `value`. Where the fit holds a parameter at
/// its bound it has no error and all of these but `value` are NaN.
struct Estimate {
  double value = 0;  ///< the estimate itself
  double standard_error_independent =
      0;                          ///< if all residuals were independent, as the paper prints
  double standard_error = 0;      ///< holds for correlated and uneven residuals
  double degrees_of_freedom = 0;  ///< of `standard_error`
  double lower = 0;               ///< 95 % confidence interval: value ± t·standard_error with
  double upper = 0;               ///< Student's t for those degrees of freedom
};

/// The bound that a parameter is held at.
enum class Bound { none, lower, upper };

/// One fitted parameter.
struct FittedParameter {
  /// "front_area_m2", "top_area_m2", "linear_m_s", "side_area_m2"; "wind_m_s", "crosswind_m_s",
  /// "roll_trim_rad" or, of several flights, "wind_m_s[0]", "wind_m_s[1]", …
  std::string name;
  Estimate estimate;             ///< SI
  Bound at_bound = Bound::none;  ///< not none: held there, without an error of its own
};

/// How the model explains the observed drag, per unit of mass: expected minus observed
/// acceleration.
struct FitQuality {
  double rmse = 0;       ///< m/s²
  double mae = 0;        ///< m/s², mean absolute residual
  double r_squared = 0;  ///< share of the observed drag's variance that the model explains
  double residual_lag1_autocorrelation = 0;  ///< mean over the flights, weighted by their samples
  std::size_t samples = 0;                   ///< of all flights
  double effective_samples = 0;              ///< independent samples the residuals are worth
};

/// The outcome of `fit_drag`.
struct DragFit {
  DragFitConditions conditions;  ///< as given
  /// rad in (−π, π], from north over east, one a flight: where one turns, its wind blows over
  /// ground, along this mean heading and to its right. Empty where the wind is told by the axes of
  /// the drone.
  std::vector<std::optional<double>> wind_heading;
  /// A_f, A_t, j, then one wind a flight; where flights show both axes then A_s, for each of them
  /// and of those that turn the crosswind, and for each of the former the roll's trim.
  std::vector<FittedParameter> parameters;
  /// Covariance of the parameters (SI units, order of `parameters`), one matrix a flight, row after
  /// row: the part of the total that this flight's residuals cause. Zero for parameters at a bound.
  std::vector<std::vector<double>> covariance_by_flight;
  /// Of each of these matrices: the cosines its long-run covariance averages over.
  std::vector<double> degrees_of_freedom_by_flight;
  /// What would have to be added to each parameter to undo, to first order, the error of
  /// differentiating speeds at the log's rate, which quick reversals make felt. The values are left
  /// as the method gives them; the squares of these are added to the variances.
  std::vector<double> differentiation_correction;
  /// The covariance if all residuals were independent.
  std::vector<double> covariance_independent;
  FitQuality quality;       ///< of the residuals of all flights
  double max_airspeed = 0;  ///< m/s, the largest |v − w| flown
  int iterations = 0;       ///< steps tried
  bool converged = false;   ///< the last step was below 1e-4 of every standard error

  [[nodiscard]] AirframeDrag drag() const;  ///< the three shared parameters, without wind
  /// A_f, m².
  [[nodiscard]] const FittedParameter& front_area() const { return parameters[0]; }
  /// A_t, m².
  [[nodiscard]] const FittedParameter& top_area() const { return parameters[1]; }
  /// j, m/s.
  [[nodiscard]] const FittedParameter& linear_speed() const { return parameters[2]; }
  /// w, m/s, one a flight.
  [[nodiscard]] std::span<const FittedParameter> wind() const {
    return std::span(parameters).subspan(3, covariance_by_flight.size());
  }
  /// The parameter of this name, such as "side_area_m2" (A_s, m²) or "crosswind_m_s[1]"; null where
  /// the flights do not show it.
  [[nodiscard]] const FittedParameter* find(std::string_view name) const;
  /// Of several flights the one of `flight`, from 0 on, such as its "crosswind_m_s"; of one flight
  /// its own.
  [[nodiscard]] const FittedParameter* find(std::string_view name, std::size_t flight) const;

  /// Correlation in [−1, 1] of parameters `i` and `j` under the honest covariance; 0 where either
  /// is at a bound.
  [[nodiscard]] double correlation(std::size_t i, std::size_t j) const;
};

/// Fits A_f, A_t, j, shared by all `flights`, and one wind a flight, by nonlinear least squares on
/// the drag over mass, `forward_drag_over_mass` = F_D/m, with the drag along the airspeed vector
/// (`airframe_drag_along`). Flights that show both axes (they turn by 20° or more, or nine tenths
/// of their speeds to the right span 3 m/s, and there they speed up as they roll) are fitted in
/// both, and give the side area A_s in place of the front area to the side, a crosswind (m/s,
/// motion of the air to the right of the heading) and the roll's trim (rad, what it reads in level
/// flight). Of a flight that turns by 90° or more and shows one axis, as without a roll, the
/// crosswind is fitted too: there it comes from ahead and from behind. Observations of the
/// published kinematics are fitted as published: one axis, and the airspeed along it alone.
///
/// The start is deterministic: for each flight the best of short descents, on a few of its samples,
/// from winds all over their range. From there a damped Gauss–Newton iteration within the bounds
/// goes to the minimum.
///
/// Errors: the independent-sample covariance is s²(JᵀJ)⁻¹; the honest one is the sandwich
/// (JᵀJ)⁻¹·N·Ω·(JᵀJ)⁻¹ with the long-run covariance Ω of the scores J_t·r_t by equally weighted
/// cosines (Lazarus, Lewis, Stock and Watson, Journal of Business & Economic Statistics 36, 2018,
/// 541–559). Flights are taken as independent of each other and degrees of freedom
/// combine after Satterthwaite. To it is added what differentiating at the log's rate costs, see
/// `differentiation_correction`. Not included: a wrong mass, density or pitch offset, effects the
/// model lacks, and the small bias of gusts that both push the drone and are pushed against
/// (simulated at the noise of the published flight it stays below half a standard error).
/// Parameters at a bound count as known in the errors of the others.
///
/// Throws UnsuitableFlight where the data cannot determine the parameters: no flight, fewer than 50
/// samples in one, speeds of all flights within 3 m/s (of the middle 90 %), accelerations that show
/// no drag, or parameters that have no separate effect. Throws std::invalid_argument for conditions
/// or bounds outside their range.
[[nodiscard]] DragFit fit_drag(std::span<const Observations> flights,
                               const DragFitConditions& conditions,
                               const DragFitOptions& options = {});

/// Drag along the forward axis at one sample.
struct DragAtSample {
  double airspeed = 0;  ///< m/s along the drone's forward axis, whichever way it points
  double tilt = 0;      ///< rad, positive leaning forward
  double measured = 0;  ///< N: mass times `forward_drag_over_mass`
  double fitted = 0;    ///< N, by the fitted law; measured less fitted is mass times the residual
};

/// What `fit` makes of every sample of the flights that it was fitted to, flight after flight.
/// Throws std::invalid_argument where they are others, as far as their number and axes tell.
[[nodiscard]] std::vector<DragAtSample> drag_at_samples(const DragFit& fit,
                                                        std::span<const Observations> flights);

/// A quantity computed from the fit, with the errors that follow from those of the parameters:
/// `gradient` is its derivative with respect to `parameters`, in SI units.
[[nodiscard]] Estimate propagate(const DragFit& fit, double value,
                                 std::span<const double> gradient);

/// Steady level flight as the fit predicts it.
struct SteadyDrag {
  double airspeed = 0;  ///< m/s
  Estimate force;       ///< N
  Estimate tilt;        ///< rad
};

/// Drag force and tilt at which the fitted drone, without tether, flies steadily at `airspeed` ≥ 0
/// in m/s: F_D(v, θ) = m·g·tanθ. This is what the data determines well even where A_f, A_t and j
/// are entangled. Empty where there is no such tilt below 60°.
[[nodiscard]] std::optional<SteadyDrag> steady_drag(const DragFit& fit, double airspeed);

/// Two parameters that the data hardly tells apart.
struct EntangledPair {
  std::size_t first = 0;   ///< indices into `DragFit::parameters`
  std::size_t second = 0;  ///< the larger one
  double correlation = 0;  ///< in [−1, 1]
};

/// Pairs correlated beyond ±0.9: each alone is then more than twice as uncertain as it would be if
/// the other were known (1/√(1 − 0.9²) = 2.3).
[[nodiscard]] std::vector<EntangledPair> entangled_pairs(const DragFit& fit);

/// Density of dry air in kg/m³ from `pressure` in Pa (> 0) and `temperature` in K (> 0), as an
/// ideal gas: p/(R·T) with R = 287.05287 J/(kg·K) (ISO 2533:1975, Standard Atmosphere). Moist air
/// is lighter, by up to 1 % at 25 °C. Throws std::invalid_argument outside the range.
[[nodiscard]] double dry_air_density(double pressure, double temperature);

}  // namespace tethercalc
