#include "tethercalc/identify/drag_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "identify/flight_units.hpp"
#include "identify/linear_algebra.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

// Notation, after the paper's section III-B: θ tilt, v forward speed over ground, w wind, u = v −
// w, A_f, A_t effective areas, j linear speed, ρ air density, m mass, k = ρ/(2m). y = expected −
// observed acceleration = F_D/m = k·(A_f cosθ + A_t |sinθ|)(u|u| + j·u). H = JᵀJ, g = Jᵀr with the
// Jacobian J of the model and the residual r = y − model.

namespace tethercalc {
namespace {

constexpr std::size_t fewest_samples =
    50;  // at 10 Hz one pass; fewer give no autocorrelation either
constexpr double smallest_speed_spread = 3.0;  // m/s: below it every column of J is nearly the same
constexpr Index shared = 3;                    // A_f, A_t, j
constexpr Index front = 0;
constexpr Index top = 1;
constexpr Index linear = 2;

struct Sample {
  double cosine;    // cosθ
  double sine;      // |sinθ|
  double speed;     // v
  double observed;  // y
};
using Samples = std::vector<Sample>;

Samples to_samples(const Observations& flight) {
  Samples samples(flight.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = {std::cos(flight.tilt[i]), std::abs(std::sin(flight.tilt[i])),
                  flight.forward_speed[i],
                  flight.expected_acceleration[i] - flight.forward_acceleration[i]};
  }
  return samples;
}

// ---- demands on the input ----

void demand(bool holds, const char* field, double value, const char* allowed) {
  if (!holds) {
    throw std::invalid_argument(fmt::format("{} is {} but must be {}", field, value, allowed));
  }
}

void demand_positive(const char* field, double value) {
  demand(value > 0 && std::isfinite(value), field, value, "positive");
}

void validate(const DragFitConditions& conditions, const DragFitOptions& options,
              std::size_t flights) {
  demand_positive("the mass in kg", conditions.mass);
  demand_positive("the air density in kg/m³", conditions.air_density);
  demand_positive("gravity in m/s²", conditions.gravity);
  demand_positive("the largest linear speed in m/s", options.bounds.max_linear_speed);
  demand_positive("the largest wind in m/s", options.bounds.max_wind);
  if (options.start) {
    demand(options.start->wind.size() == flights, "the number of winds to start from",
           static_cast<double>(options.start->wind.size()), "the number of flights");
  }
}

void demand_enough_samples(std::span<const Observations> flights) {
  if (flights.empty()) throw UnsuitableFlight("a drag fit needs at least one flight");
  for (std::size_t k = 0; k < flights.size(); ++k) {
    if (flights[k].size() < fewest_samples) {
      throw UnsuitableFlight(
          fmt::format("flight {} has {} samples in the chosen range; a drag fit needs at least {}",
                      k + 1, flights[k].size(), fewest_samples));
    }
  }
}

void demand_speed_spread(std::span<const Observations> flights) {
  std::vector<double> speeds;
  for (const auto& flight : flights) {
    speeds.insert(speeds.end(), flight.forward_speed.begin(), flight.forward_speed.end());
  }
  const double slow = quantile(speeds, 0.05);
  const double fast = quantile(speeds, 0.95);
  if (fast - slow < smallest_speed_spread) {
    throw UnsuitableFlight(fmt::format(
        "the forward speed stays between {:.2f} and {:.2f} m/s for 90 % of the samples; to tell "
        "drag from wind it must vary by at least {} m/s: fly forward and backward at several tilts",
        slow, fast, smallest_speed_spread));
  }
}

// ---- damped Gauss–Newton within bounds ----

// The sum of squares has a long bent valley along A·j = const: at one speed, only the drag there is
// known. It is followed in coordinates in which it is straight, for a reference speed V:
// y = (A_f·(V + j)/V, A_t·(V + j)/V, q, w…) with q = j/(V + j), the share of the linear part in the
// drag at V. Drag is linear in q and in the first two.
constexpr double reference_speed = 10;  // m/s, amid the speeds that are flown

VectorXd straightened(VectorXd x) {
  const double growth = 1 + x(linear) / reference_speed;
  x.head<2>() *= growth;
  x(linear) = x(linear) / (reference_speed * growth);
  return x;
}

VectorXd unstraightened(VectorXd y) {
  const double rest = 1 - y(linear);
  y.head<2>() *= rest;
  y(linear) = reference_speed * y(linear) / rest;
  return y;
}

/// dx/dy, the identity but for the shared parameters.
MatrixXd straightening_jacobian(const VectorXd& y) {
  const double rest = 1 - y(linear);
  MatrixXd t = MatrixXd::Identity(y.size(), y.size());
  t(front, front) = t(top, top) = rest;
  t(front, linear) = -y(front);
  t(top, linear) = -y(top);
  t(linear, linear) = reference_speed / (rest * rest);
  return t;
}

/// Bounds of y.
struct Box {
  VectorXd lower;
  VectorXd upper;
};

Box box(const DragBounds& bounds, Index flights) {
  Box out{VectorXd::Constant(shared + flights, -bounds.max_wind),
          VectorXd::Constant(shared + flights, bounds.max_wind)};
  out.lower.head<shared>().setZero();
  out.upper.head<2>().setConstant(infinity);
  out.upper(linear) = bounds.max_linear_speed / (reference_speed + bounds.max_linear_speed);
  return out;
}

struct LocalDrag {
  AirframeDrag law;
  double wind;
};

LocalDrag local(const VectorXd& x, Index flight) {
  return {{x(front), x(top), x(linear), 0}, x(shared + flight)};
}

/// One row of J, by A_f, A_t, j and the wind, and the residual.
struct Row {
  Eigen::Vector4d slopes;
  double residual;
};

inline Row row_at(const Sample& s, double k, const LocalDrag& drag) {
  const AirframeDragSlopes d =
      airframe_drag_slopes(drag.law, 2 * k, s.speed - drag.wind, s.cosine, s.sine);
  return {{d.by_front_area, d.by_top_area, d.by_linear_speed, -d.by_airspeed},
          s.observed - d.force};
}

/// Where the columns of a flight's rows stand among all parameters.
std::array<Index, 4> places(std::size_t flight) {
  return {front, top, linear, shared + static_cast<Index>(flight)};
}

struct NormalEquations {
  MatrixXd h;
  VectorXd g;
  double sse = 0;
};

NormalEquations normal_equations(const std::vector<Samples>& flights, double k, const VectorXd& x) {
  NormalEquations out{MatrixXd::Zero(x.size(), x.size()), VectorXd::Zero(x.size()), 0};
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const LocalDrag drag = local(x, static_cast<Index>(f));
    Eigen::Matrix4d h = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    for (const Sample& s : flights[f]) {
      const Row r = row_at(s, k, drag);
      h += r.slopes * r.slopes.transpose();
      g += r.slopes * r.residual;
      out.sse += r.residual * r.residual;
    }
    out.h(places(f), places(f)) += h;
    out.g(places(f)) += g;
  }
  return out;
}

/// Parameters that may move: all but those at a bound that the data pushes outward.
std::vector<Index> free_parameters(const VectorXd& y, const VectorXd& g, const Box& within) {
  std::vector<Index> free;
  for (Index i = 0; i < y.size(); ++i) {
    const bool held =
        (y(i) <= within.lower(i) && g(i) < 0) || (y(i) >= within.upper(i) && g(i) > 0);
    if (!held) free.push_back(i);
  }
  return free;
}

/// A point with its normal equations in both coordinates.
struct Point {
  VectorXd y;
  VectorXd x;
  NormalEquations in_y;
  NormalEquations in_x;
};

Point point_at(const std::vector<Samples>& flights, double k, const VectorXd& y) {
  Point p{y, unstraightened(y), {}, {}};
  p.in_x = normal_equations(flights, k, p.x);
  const MatrixXd t = straightening_jacobian(y);
  p.in_y = {t.transpose() * p.in_x.h * t, t.transpose() * p.in_x.g, p.in_x.sse};
  return p;
}

struct Minimum {
  VectorXd x;
  NormalEquations at;  // in x
  std::vector<Index> free;
  std::vector<Bound> bounds;  // one a parameter
  int iterations = 0;
  bool converged = false;
};

/// Levenberg and Marquardt's damping on the free parameters, each step projected onto the box. Own
/// code because Eigen's unsupported module knows no bounds and wants the whole Jacobian, whose
/// decomposition costs more than this problem: three shared parameters and a diagonal block.
Minimum minimise(const std::vector<Samples>& flights, double k, const VectorXd& start,
                 const Box& within) {
  constexpr int most_iterations = 200;  // 5 to 10 are used; the rest is for a start from afar
  // A step this small against every standard error is far below anything printed, and still lowers
  // the sum of squares by more than its rounding error (1e-8/N against 1e-16).
  constexpr double negligible = 1e-4;
  constexpr double rounding = 1e-13;  // of the observations: where noise-free data ends
  constexpr double least_damping = 1e-9;
  constexpr double most_damping = 1e12;

  double count = 0;
  double power = 0;
  for (const auto& flight : flights) {
    count += static_cast<double>(flight.size());
    for (const Sample& s : flight) power += s.observed * s.observed;
  }
  const double freedom = count - static_cast<double>(start.size());

  Minimum out;
  Point best =
      point_at(flights, k, straightened(start).cwiseMax(within.lower).cwiseMin(within.upper));
  double damping = 1e-4;
  while (out.iterations < most_iterations && damping < most_damping) {
    ++out.iterations;
    const auto free = free_parameters(best.y, best.in_y.g, within);
    const MatrixXd h = best.in_y.h(free, free);
    const VectorXd g = best.in_y.g(free);
    // An area at 0 leaves columns of zeros; any positive number keeps such a parameter in place.
    const VectorXd scale = h.diagonal().cwiseMax(std::numeric_limits<double>::min());
    const VectorXd step = solve_symmetric(h + MatrixXd(damping * scale.asDiagonal()), g);

    VectorXd y = best.y;
    for (std::size_t i = 0; i < free.size(); ++i) y(free[i]) += step(static_cast<Index>(i));
    y = y.cwiseMax(within.lower).cwiseMin(within.upper);
    const VectorXd moved = y - best.y;
    // movedᵀ·H·moved ≤ ε²·s² bounds every |moved_i| by ε standard errors.
    const bool small =
        moved.dot(best.in_y.h * moved) <=
        std::max(negligible * negligible * best.in_y.sse / freedom, rounding * rounding * power);
    Point next = point_at(flights, k, y);
    if (next.in_y.sse < best.in_y.sse) {
      best = std::move(next);
      damping = std::max(damping / 10, least_damping);
    } else {
      damping *= 10;
    }
    if (small && damping < 1) {
      out.converged = true;
      break;
    }
  }
  out.free = free_parameters(best.y, best.in_y.g, within);
  out.bounds.assign(static_cast<std::size_t>(best.y.size()), Bound::lower);
  for (Index i = 0; i < best.y.size(); ++i) {
    if (best.y(i) >= within.upper(i)) out.bounds[static_cast<std::size_t>(i)] = Bound::upper;
  }
  for (Index i : out.free) out.bounds[static_cast<std::size_t>(i)] = Bound::none;
  out.x = std::move(best.x);
  out.at = std::move(best.in_x);
  return out;
}

// ---- the deterministic start ----

/// At most about `count` of them, evenly spread: a start need not be precise.
Samples thinned(const Samples& samples, std::size_t count) {
  Samples few;
  const std::size_t stride = 1 + samples.size() / count;
  for (std::size_t i = 0; i < samples.size(); i += stride) few.push_back(samples[i]);
  return few;
}

/// The best of descents from winds all over their range: in all but the wind the straightened model
/// is linear or nearly so.
VectorXd start_of(const Samples& flight, double k, const DragBounds& bounds) {
  constexpr double widest_step = 4;  // m/s, about half of the speeds over which the model bends
  const auto steps = static_cast<int>(std::ceil(bounds.max_wind / widest_step));
  const std::vector<Samples> few{thinned(flight, 200)};
  Minimum best;
  for (int i = -steps; i <= steps; ++i) {
    const VectorXd start{{0, 0, 1, bounds.max_wind * i / steps}};
    Minimum found = minimise(few, k, start, box(bounds, 1));
    if (best.x.size() == 0 || found.at.sse < best.at.sse) best = std::move(found);
  }
  return best.x;
}

/// Each flight's own wind, and the mean of what the flights take for what they share.
VectorXd joint_start(const std::vector<Samples>& flights, double k, const DragBounds& bounds) {
  const auto count = static_cast<Index>(flights.size());
  VectorXd start = VectorXd::Zero(shared + count);
  for (Index f = 0; f < count; ++f) {
    const VectorXd own = start_of(flights[static_cast<std::size_t>(f)], k, bounds);
    start.head<shared>() += own.head<shared>() / static_cast<double>(count);
    start(shared + f) = own(shared);
  }
  return start;
}

// ---- errors and quality ----

std::vector<std::string> parameter_names(std::size_t flights) {
  std::vector<std::string> names{"front_area_m2", "top_area_m2", "linear_m_s"};
  if (flights == 1) names.emplace_back("wind_m_s");
  for (std::size_t f = 0; flights > 1 && f < flights; ++f) {
    names.push_back(fmt::format("wind_m_s[{}]", f));
  }
  return names;
}

void demand_drag(const VectorXd& x) {
  if (x(front) > 0 || x(top) > 0) return;
  throw UnsuitableFlight(
      "the flight shows no drag: the drone accelerates at least as its tilt alone would make it. "
      "Is the pitch positive nose-up, and is the pitch offset right?");
}

/// Throws where some combination of the free parameters leaves no trace in the residuals.
void demand_separate_effects(const Minimum& minimum, const std::vector<std::string>& names) {
  constexpr double singular = 1e-9;  // errors 30,000 times those of the parameters taken alone
  const MatrixXd h = minimum.at.h(minimum.free, minimum.free);
  const VectorXd scale =
      h.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  const LeastEigenvalue least = least_eigenvalue(scale.asDiagonal() * h * scale.asDiagonal());
  if (least.value > singular) return;
  std::vector<std::string> involved;
  for (std::size_t i = 0; i < minimum.free.size(); ++i) {
    if (std::abs(least.direction(static_cast<Index>(i))) > 0.1) {
      involved.push_back(names[static_cast<std::size_t>(minimum.free[i])]);
    }
  }
  throw UnsuitableFlight(fmt::format(
      "the flight cannot determine {}: fly forward and backward, at several tilts and speeds",
      fmt::join(involved, " and ")));
}

/// H⁻¹ over the free parameters, zero elsewhere.
MatrixXd free_inverse(const Minimum& minimum) {
  const auto free = static_cast<Index>(minimum.free.size());
  MatrixXd inverse = MatrixXd::Zero(minimum.x.size(), minimum.x.size());
  inverse(minimum.free, minimum.free) =
      solve_symmetric(minimum.at.h(minimum.free, minimum.free), MatrixXd::Identity(free, free));
  return inverse;
}

std::vector<double> flatten(const MatrixXd& symmetric) {
  return {symmetric.data(), symmetric.data() + symmetric.size()};
}

/// Residuals and scores J_t·r_t of one flight, the latter in rows of four.
struct Scores {
  std::vector<double> residuals;
  std::vector<double> rows;
};

Scores scores_of(const Samples& samples, double k, const LocalDrag& drag) {
  Scores out;
  out.residuals.reserve(samples.size());
  out.rows.reserve(4 * samples.size());
  for (const Sample& s : samples) {
    const Row r = row_at(s, k, drag);
    out.residuals.push_back(r.residual);
    for (const double slope : r.slopes) out.rows.push_back(slope * r.residual);
  }
  return out;
}

/// What undoes the central differences' own error in the parameters, to first order: H⁻¹·Jᵀe. The
/// leading error of a central difference of v over steps h is e = h²/6·d²a/dt² (Abramowitz and
/// Stegun 25.3.21), here from second differences of the acceleration that tilt and fitted drag
/// predict: that of the observed one would be noise. Samples beside a gap or at an end count as
/// exact.
VectorXd differentiation_correction(std::span<const Observations> flights,
                                    const std::vector<Samples>& samples, double k,
                                    const Minimum& minimum, const MatrixXd& inverse) {
  VectorXd pull = VectorXd::Zero(minimum.x.size());
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const Observations& flight = flights[f];
    const LocalDrag drag = local(minimum.x, static_cast<Index>(f));
    std::vector<double> predicted = flight.forward_acceleration;
    for (std::size_t i = 0; i < flight.size(); ++i) {
      predicted[i] += row_at(samples[f][i], k, drag).residual;
    }
    for (std::size_t i = 1; i + 1 < flight.size(); ++i) {
      const double before = flight.time[i] - flight.time[i - 1];
      const double after = flight.time[i + 1] - flight.time[i];
      if (before > 2 * after || after > 2 * before) continue;
      const double error = (predicted[i - 1] - 2 * predicted[i] + predicted[i + 1]) / 6;
      pull(places(f)) += error * row_at(samples[f][i], k, drag).slopes;
    }
  }
  return inverse * pull;
}

double quadratic_form(std::span<const double> a, std::span<const double> matrix) {
  const auto size = static_cast<Index>(a.size());
  const Eigen::Map<const VectorXd> x(a.data(), size);
  return x.dot(Eigen::Map<const MatrixXd>(matrix.data(), size, size) * x);
}

}  // namespace

AirframeDrag DragFit::drag() const {
  return {front_area().estimate.value, top_area().estimate.value, linear_speed().estimate.value, 0};
}

double DragFit::correlation(std::size_t i, std::size_t j) const {
  const auto covariance = [this](std::size_t a, std::size_t b) {
    double sum = differentiation_correction[a] * differentiation_correction[b];
    for (const auto& part : covariance_by_flight) sum += part[a * parameters.size() + b];
    return sum;
  };
  const double both = std::sqrt(covariance(i, i) * covariance(j, j));
  return both > 0 ? std::clamp(covariance(i, j) / both, -1.0, 1.0) : 0;
}

Estimate propagate(const DragFit& fit, double value, std::span<const double> gradient) {
  // Flights are independent, so variances add, and degrees of freedom combine after Satterthwaite
  // (1946).
  double variance = 0;
  double spread = 0;
  for (std::size_t f = 0; f < fit.covariance_by_flight.size(); ++f) {
    const double part = quadratic_form(gradient, fit.covariance_by_flight[f]);
    variance += part;
    spread += part * part / fit.degrees_of_freedom_by_flight[f];
  }
  const double correction = std::inner_product(gradient.begin(), gradient.end(),
                                               fit.differentiation_correction.begin(), 0.0);
  Estimate out;
  out.value = value;
  out.standard_error_independent = std::sqrt(quadratic_form(gradient, fit.covariance_independent));
  out.standard_error = std::sqrt(variance + correction * correction);
  double half_width = 0;  // without variance the value is exact
  if (spread > 0) {
    out.degrees_of_freedom = variance * variance / spread;
    half_width = student_quantile(out.degrees_of_freedom, 0.975) * out.standard_error;
  }
  out.lower = value - half_width;
  out.upper = value + half_width;
  return out;
}

DragFit fit_drag(std::span<const Observations> flights, const DragFitConditions& conditions,
                 const DragFitOptions& options) {
  validate(conditions, options, flights.size());
  demand_enough_samples(flights);
  demand_speed_spread(flights);

  std::vector<Samples> samples;
  for (const auto& flight : flights) samples.push_back(to_samples(flight));
  const double k = conditions.air_density / (2 * conditions.mass);
  const Box within = box(options.bounds, static_cast<Index>(flights.size()));

  VectorXd start;
  if (options.start) {
    start.resize(within.lower.size());
    start.head<shared>() << options.start->front_area, options.start->top_area,
        options.start->linear_speed;
    start.tail(static_cast<Index>(flights.size())) =
        Eigen::Map<const VectorXd>(options.start->wind.data(), static_cast<Index>(flights.size()));
  } else {
    start = joint_start(samples, k, options.bounds);
  }
  const Minimum minimum = minimise(samples, k, start, within);
  const auto names = parameter_names(flights.size());
  demand_drag(minimum.x);
  demand_separate_effects(minimum, names);

  DragFit fit;
  fit.conditions = conditions;
  fit.iterations = minimum.iterations;
  fit.converged = minimum.converged;

  const MatrixXd inverse = free_inverse(minimum);
  const VectorXd undone = differentiation_correction(flights, samples, k, minimum, inverse);
  fit.differentiation_correction.assign(undone.data(), undone.data() + undone.size());

  // Residual statistics and the honest covariance, flight by flight.
  const auto size = minimum.x.size();
  FitQuality& quality = fit.quality;
  double sum = 0;
  double sum_of_squares = 0;
  for (const auto& flight : samples) {
    quality.samples += flight.size();
    for (const Sample& s : flight) sum += s.observed;
  }
  const auto count = static_cast<double>(quality.samples);
  const double correction = count / (count - static_cast<double>(minimum.free.size()));
  for (std::size_t f = 0; f < samples.size(); ++f) {
    const LocalDrag drag = local(minimum.x, static_cast<Index>(f));
    const Scores scores = scores_of(samples[f], k, drag);
    const auto length = static_cast<double>(samples[f].size());
    const double effective = effective_sample_size(scores.residuals);
    const std::size_t terms = cosine_terms(length, effective);
    const auto omega = long_run_covariance(scores.rows, 4, terms);

    MatrixXd middle = MatrixXd::Zero(size, size);
    middle(places(f), places(f)) = Eigen::Map<const Eigen::Matrix4d>(omega.data()) * length;
    fit.covariance_by_flight.push_back(flatten(inverse * middle * inverse * correction));
    fit.degrees_of_freedom_by_flight.push_back(static_cast<double>(terms));

    quality.effective_samples += effective;
    quality.residual_lag1_autocorrelation += autocorrelation(scores.residuals, 1) * length / count;
    for (double r : scores.residuals) quality.mae += std::abs(r) / count;
    for (const Sample& s : samples[f]) {
      sum_of_squares += (s.observed - sum / count) * (s.observed - sum / count);
      fit.max_airspeed = std::max(fit.max_airspeed, std::abs(s.speed - drag.wind));
    }
  }
  quality.rmse = std::sqrt(minimum.at.sse / count);
  quality.r_squared = sum_of_squares > 0 ? 1 - minimum.at.sse / sum_of_squares : 0;
  fit.covariance_independent = flatten(inverse * (minimum.at.sse / count * correction));

  for (Index i = 0; i < size; ++i) {
    const auto p = static_cast<std::size_t>(i);
    std::vector<double> gradient(names.size(), 0.0);
    gradient[p] = 1;
    const bool free = minimum.bounds[p] == Bound::none;
    fit.parameters.push_back({names[p],
                              free ? propagate(fit, minimum.x(i), gradient)
                                   : Estimate{minimum.x(i), nan, nan, nan, nan, nan},
                              minimum.bounds[p]});
  }
  return fit;
}

std::optional<SteadyDrag> steady_drag(const DragFit& fit, double airspeed) {
  const double steepest = std::tan(60 * unit::degree);
  const AirframeDrag drag = fit.drag();
  const double weight = fit.conditions.mass * fit.conditions.gravity;
  const double density = fit.conditions.air_density;
  const double factor = area_force_factor(drag, density, airspeed);
  const double t =
      equilibrium_tan_pitch({weight, factor, 0, drag.front_area, drag.top_area}, steepest);
  if (!std::isfinite(t)) return std::nullopt;

  // Implicit derivative of weight·t = factor·(A_f + A_t·t)/√(1 + t²).
  const double secant = std::sqrt(1 + t * t);
  const AirframeDragSlopes d =
      airframe_drag_slopes(drag, density, airspeed, 1 / secant, t / secant);
  const double stiffness =
      weight - factor * (drag.top_area - drag.front_area * t) / (secant * secant * secant);
  std::vector<double> gradient(fit.parameters.size(), 0.0);
  gradient[front] = d.by_front_area / stiffness;
  gradient[top] = d.by_top_area / stiffness;
  gradient[linear] = d.by_linear_speed / stiffness;

  const auto scaled = [&gradient](double by) {
    std::vector<double> out = gradient;
    for (double& g : out) g *= by;
    return out;
  };
  return SteadyDrag{airspeed, propagate(fit, weight * t, scaled(weight)),
                    propagate(fit, std::atan(t), scaled(1 / (secant * secant)))};
}

std::vector<EntangledPair> entangled_pairs(const DragFit& fit) {
  constexpr double entangled = 0.9;
  std::vector<EntangledPair> pairs;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    for (std::size_t j = i + 1; j < fit.parameters.size(); ++j) {
      const double correlation = fit.correlation(i, j);
      if (std::abs(correlation) > entangled) pairs.push_back({i, j, correlation});
    }
  }
  return pairs;
}

double dry_air_density(double pressure, double temperature) {
  constexpr double gas_constant = 287.05287;  // J/(kg·K), ISO 2533:1975
  demand_positive("the pressure in Pa", pressure);
  demand_positive("the temperature in K", temperature);
  return pressure / (gas_constant * temperature);
}

Observations observe_part(const FlightLog& log, const DragIdentificationOptions& options) {
  validate(log);
  const bool chosen = options.from || options.to;
  const SampleRange range = chosen ? select_range(log, options.from, options.to) : moving_part(log);
  const double gravity = options.conditions.gravity;
  Observations flight = observe(log, range, options.pitch_offset, gravity);
  check_flight_units(flight, gravity);
  return flight;
}

DragIdentification identify_drag(std::span<const FlightLog> logs,
                                 const DragIdentificationOptions& options) {
  DragIdentification out;
  out.options = options;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    try {
      out.flights.push_back(observe_part(logs[i], options));
    } catch (const UnsuitableFlight& error) {
      if (logs.size() == 1) throw;
      throw UnsuitableFlight(fmt::format("log {}: {}", i + 1, error.what()));
    }
    if (out.flights.back().size() == 0) {
      throw UnsuitableFlight(fmt::format("log {} is all gaps", i + 1));
    }
  }
  out.fit = fit_drag(out.flights, options.conditions);
  return out;
}

}  // namespace tethercalc
