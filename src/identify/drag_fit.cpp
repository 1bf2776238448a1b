#include "tethercalc/identify/drag_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "identify/flight_units.hpp"
#include "identify/linear_algebra.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

// Notation, after the paper's section III-B: θ tilt, v forward speed over ground, w wind, u = v −
// w, A_f, A_t effective areas, j linear speed, ρ air density, m mass, k = ρ/(2m). y = expected −
// observed acceleration = F_D/m = k·(A_f cosθ + A_t |sinθ|)(U + j)·u with U the magnitude of the
// airspeed; to the right alike with A_s, the crosswind c and the roll's trim. H = JᵀJ, g = Jᵀr with
// the Jacobian J of the model and the residual r = y − model.

namespace tethercalc {
namespace {

constexpr std::size_t fewest_samples =
    50;  // at 10 Hz one pass; fewer give no autocorrelation either
constexpr double smallest_speed_spread = 3.0;  // m/s: below it every column of J is nearly the same
constexpr Index shared = 3;                    // A_f, A_t, j
constexpr Index front = 0;
constexpr Index top = 1;
constexpr Index linear = 2;

/// One axis of one sample.
struct Reading {
  double cosine;    // cosθ, to the right of the roll's part
  double sine;      // |sinθ|
  double speed;     // v
  double observed;  // y
};

struct Sample {
  double ahead;             // how far forward is along the mean heading,
  double right_of_heading;  // and how far to its right; 1 and 0 in a flight that hardly turns
  Reading forward;
  double right_speed;  // 0 in the published kinematics
  Reading right;       // of both axes
  double lift;         // m/s² that the thrust carries
};

/// Of one flight.
struct Samples {
  std::vector<Sample> all;
  bool both_axes = false;
  std::optional<double> wind_heading{};  // as in `DragFit`

  [[nodiscard]] std::size_t size() const { return all.size(); }
  [[nodiscard]] std::size_t rows() const { return all.size() * (both_axes ? 2 : 1); }
};

Samples to_samples(const Observations& flight, double gravity) {
  const bool exact = flight.kinematics == Kinematics::exact;
  Samples samples{
      std::vector<Sample>(flight.size()), exact && shows_both_axes(flight, gravity), {}};
  const std::vector<double> drag = forward_drag_over_mass(flight);
  // Seen along one axis alone, a wind across hardly differs from linear drag unless it comes ahead.
  constexpr double quarter = 90 * unit::degree;
  if (exact && (samples.both_axes ? turns(flight) : turns(flight, quarter))) {
    samples.wind_heading = mean_heading(flight);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& s = samples.all[i];
    const double off = samples.wind_heading ? flight.yaw[i] - *samples.wind_heading : 0;
    s.ahead = std::cos(off);
    s.right_of_heading = std::sin(off);
    const double cosine = std::cos(flight.tilt[i]);
    s.forward = {cosine, std::abs(std::sin(flight.tilt[i])), flight.forward_speed[i], drag[i]};
    s.right_speed = exact ? flight.right_speed[i] : 0;
    if (!samples.both_axes) continue;
    s.lift = gravity - flight.down_acceleration[i];
    const double thrust = std::tan(flight.roll[i]) / cosine;  // of what it carries
    const double level = 1 / std::sqrt(1 + thrust * thrust);
    s.right = {level, std::abs(thrust) * level, flight.right_speed[i],
               s.lift * thrust - flight.right_acceleration[i]};
  }
  return samples;
}

std::vector<Samples> samples_of(std::span<const Observations> flights, double gravity) {
  std::vector<Samples> samples;
  for (const auto& flight : flights) samples.push_back(to_samples(flight, gravity));
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

/// Where parameters stand. Those of the forward axis come first, then the side area where flights
/// show both axes, a crosswind for each of these and of those that turn, and a roll trim for each
/// of the former.
struct Places {
  explicit Places(const std::vector<Samples>& flights) : size(shared + Index(flights.size())) {
    areas = {front, top};
    for (std::size_t f = 0; f < flights.size(); ++f) {
      of_flight.push_back({front, top, linear, shared + Index(f)});
    }
    for (std::size_t f = 0; f < flights.size(); ++f) {
      const bool both_axes = flights[f].both_axes;
      if (both_axes && areas.size() == 2) areas.push_back(size++);
      if (both_axes || flights[f].wind_heading) of_flight[f].push_back(size++);
      if (!both_axes) continue;
      of_flight[f].push_back(areas[2]);
      of_flight[f].push_back(size++);
    }
  }
  Index size = 0;
  std::vector<Index> areas;
  /// A_f, A_t, j, w; c of a flight that turns; c, A_s and the trim of one of both axes.
  std::vector<std::vector<Index>> of_flight;
};

VectorXd straightened(VectorXd x, const Places& places) {
  const double growth = 1 + x(linear) / reference_speed;
  x(places.areas) *= growth;
  x(linear) = x(linear) / (reference_speed * growth);
  return x;
}

VectorXd unstraightened(VectorXd y, const Places& places) {
  const double rest = 1 - y(linear);
  y(places.areas) *= rest;
  y(linear) = reference_speed * y(linear) / rest;
  return y;
}

/// dx/dy, the identity but for the shared parameters.
MatrixXd straightening_jacobian(const VectorXd& y, const Places& places) {
  const double rest = 1 - y(linear);
  MatrixXd t = MatrixXd::Identity(y.size(), y.size());
  for (const Index area : places.areas) {
    t(area, area) = rest;
    t(area, linear) = -y(area);
  }
  t(linear, linear) = reference_speed / (rest * rest);
  return t;
}

/// Bounds of y.
struct Box {
  VectorXd lower;
  VectorXd upper;
};

constexpr double largest_roll_trim = 0.35;  // rad, beyond any autopilot that flies

Box box(const DragBounds& bounds, const Places& places) {
  Box out{VectorXd::Constant(places.size, -bounds.max_wind),
          VectorXd::Constant(places.size, bounds.max_wind)};
  out.lower(places.areas).setZero();
  out.upper(places.areas).setConstant(infinity);
  out.lower(linear) = 0;
  out.upper(linear) = bounds.max_linear_speed / (reference_speed + bounds.max_linear_speed);
  for (const std::vector<Index>& own : places.of_flight) {
    if (own.size() <= 5) continue;
    out.lower(own[6]) = -largest_roll_trim;
    out.upper(own[6]) = largest_roll_trim;
  }
  return out;
}

/// A_f, A_t, j, w, c, A_s and the trim, as far as a flight has them; else neutral.
using Local = Eigen::Matrix<double, 7, 1>;

Local local(const VectorXd& x, const std::vector<Index>& places) {
  Local own = Local::Zero();
  own.head(Index(places.size())) = x(places);
  return own;
}

/// One row of J by the parameters of a flight, and the residual.
struct Row {
  Local slopes = Local::Zero();
  double residual = 0;
};

/// m/s, by the drone's own axes.
struct Airspeed {
  double ahead;
  double aside;
};

inline Airspeed airspeed(const Sample& s, const Local& p) {
  const double c = s.ahead;
  const double h = s.right_of_heading;
  return {s.forward.speed - p[3] * c - p[4] * h, s.right_speed - p[4] * c + p[3] * h};
}

inline Row forward_row(const Sample& s, double k, const Local& p) {
  const Reading& r = s.forward;
  const Airspeed u = airspeed(s, p);
  const double c = s.ahead;
  const double h = s.right_of_heading;
  const AirframeDragSlopes d =
      airframe_drag_slopes({p[0], p[1], p[2], 0}, 2 * k, u.ahead, u.aside, r.cosine, r.sine);
  return {{d.by_front_area, d.by_top_area, d.by_linear_speed, d.by_across * h - d.by_along * c,
           -d.by_along * h - d.by_across * c, 0, 0},
          r.observed - d.force};
}

/// Of a flight of both axes.
inline Row right_row(const Sample& s, double k, const Local& p) {
  const Reading& r = s.right;
  const Airspeed u = airspeed(s, p);
  const double c = s.ahead;
  const double h = s.right_of_heading;
  const AirframeDragSlopes d =
      airframe_drag_slopes({p[5], p[1], p[2], 0}, 2 * k, u.aside, u.ahead, r.cosine, r.sine);
  return {{0, d.by_top_area, d.by_linear_speed, d.by_along * h - d.by_across * c,
           -d.by_along * c - d.by_across * h, d.by_front_area, s.lift},
          r.observed - d.force - s.lift * p[6]};
}

/// The rows of a sample, one or two.
template <typename Use>
void for_rows(const Samples& flight, std::size_t i, double k, const Local& p, const Use& use) {
  use(forward_row(flight.all[i], k, p));
  if (flight.both_axes) use(right_row(flight.all[i], k, p));
}

struct NormalEquations {
  MatrixXd h;
  VectorXd g;
  double sse = 0;
};

NormalEquations normal_equations(const std::vector<Samples>& flights, double k, const VectorXd& x,
                                 const Places& places) {
  NormalEquations out{MatrixXd::Zero(x.size(), x.size()), VectorXd::Zero(x.size()), 0};
  const auto add = [&out](const std::vector<Samples>& of, std::size_t f, double density_over_mass,
                          const std::vector<Index>& own, const Local& p, auto columns) {
    constexpr int size = decltype(columns)::value;
    Eigen::Matrix<double, size, size> h = Eigen::Matrix<double, size, size>::Zero();
    Eigen::Matrix<double, size, 1> g = Eigen::Matrix<double, size, 1>::Zero();
    for (std::size_t i = 0; i < of[f].size(); ++i) {
      for_rows(of[f], i, density_over_mass, p, [&](const Row& r) {
        const auto slopes = r.slopes.template head<size>();
        h += slopes * slopes.transpose();
        g += slopes * r.residual;
        out.sse += r.residual * r.residual;
      });
    }
    out.h(own, own) += h;
    out.g(own) += g;
  };
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const std::vector<Index>& own = places.of_flight[f];
    const Local p = local(x, own);
    if (flights[f].both_axes) {
      add(flights, f, k, own, p, std::integral_constant<int, 7>());
    } else if (flights[f].wind_heading) {
      add(flights, f, k, own, p, std::integral_constant<int, 5>());
    } else {
      add(flights, f, k, own, p, std::integral_constant<int, 4>());
    }
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

Point point_at(const std::vector<Samples>& flights, double k, const VectorXd& y,
               const Places& places) {
  Point p{y, unstraightened(y, places), {}, {}};
  p.in_x = normal_equations(flights, k, p.x, places);
  const MatrixXd t = straightening_jacobian(y, places);
  p.in_y = {product(inner_products(t, p.in_x.h), t), inner_products_with(t, p.in_x.g), p.in_x.sse};
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
/// decomposition costs more than this problem: a few shared parameters and a diagonal block.
Minimum minimise(const std::vector<Samples>& flights, double k, const VectorXd& start,
                 const Places& places, const Box& within) {
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
    count += static_cast<double>(flight.rows());
    for (const Sample& s : flight.all) power += s.forward.observed * s.forward.observed;
  }
  const double freedom = count - static_cast<double>(start.size());

  Minimum out;
  Point best =
      point_at(flights, k,
               straightened(start, places).cwiseMax(within.lower).cwiseMin(within.upper), places);
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
    Point next = point_at(flights, k, y, places);
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
  for (std::size_t i = 0; i < samples.size(); i += stride) few.all.push_back(samples.all[i]);
  return few;
}

/// The best of descents from winds all over their range: in all but the wind the straightened model
/// is linear or nearly so. The forward axis is enough for that.
VectorXd start_of(const Samples& flight, double k, const DragBounds& bounds) {
  constexpr double widest_step = 4;  // m/s, about half of the speeds over which the model bends
  const auto steps = static_cast<int>(std::ceil(bounds.max_wind / widest_step));
  const std::vector<Samples> few{thinned(flight, 200)};
  const Places places(few);
  Minimum best;
  for (int i = -steps; i <= steps; ++i) {
    const VectorXd start{{0, 0, 1, bounds.max_wind * i / steps}};
    Minimum found = minimise(few, k, start, places, box(bounds, places));
    if (best.x.size() == 0 || found.at.sse < best.at.sse) best = std::move(found);
  }
  return best.x;
}

/// Each flight's own wind, and the mean of what the flights take for what they share.
VectorXd joint_start(const std::vector<Samples>& flights, double k, const DragBounds& bounds,
                     const Places& places) {
  const auto count = static_cast<Index>(flights.size());
  VectorXd start = VectorXd::Zero(places.size);
  for (Index f = 0; f < count; ++f) {
    const VectorXd own = start_of(flights[static_cast<std::size_t>(f)], k, bounds);
    start.head<shared>() += own.head<shared>() / static_cast<double>(count);
    start(shared + f) = own(shared);
  }
  return start;
}

// ---- errors and quality ----

std::vector<std::string> parameter_names(const Places& places) {
  const std::size_t flights = places.of_flight.size();
  const auto of_flight = [flights](const char* name, std::size_t f) {
    return flights > 1 ? fmt::format("{}[{}]", name, f) : name;
  };
  std::vector<std::string> names(static_cast<std::size_t>(places.size));
  const auto name = [&names](Index place, std::string words) {
    names[static_cast<std::size_t>(place)] = std::move(words);
  };
  name(front, "front_area_m2");
  name(top, "top_area_m2");
  name(linear, "linear_m_s");
  for (std::size_t f = 0; f < flights; ++f) {
    const std::vector<Index>& own = places.of_flight[f];
    name(own[3], of_flight("wind_m_s", f));
    if (own.size() > 4) name(own[4], of_flight("crosswind_m_s", f));
    if (own.size() <= 5) continue;
    name(own[5], "side_area_m2");
    name(own[6], of_flight("roll_trim_rad", f));
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

/// Residuals and scores J_t·r_t of one flight, the latter in rows of `columns`, of both axes their
/// sum.
struct Scores {
  std::vector<double> residuals;
  std::vector<double> right_residuals;
  std::vector<double> rows;
};

Scores scores_of(const Samples& samples, double k, const Local& p, std::size_t columns) {
  Scores out;
  out.residuals.reserve(samples.size());
  out.rows.reserve(columns * samples.size());
  for (const Sample& s : samples.all) {
    const Row r = forward_row(s, k, p);
    Local score = r.slopes * r.residual;
    out.residuals.push_back(r.residual);
    if (samples.both_axes) {
      const Row right = right_row(s, k, p);
      score += right.slopes * right.residual;
      out.right_residuals.push_back(right.residual);
    }
    out.rows.insert(out.rows.end(), score.begin(), score.begin() + Index(columns));
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
                                    const Minimum& minimum, const Places& places,
                                    const MatrixXd& inverse) {
  VectorXd pull = VectorXd::Zero(minimum.x.size());
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const Observations& flight = flights[f];
    const std::vector<Index>& own = places.of_flight[f];
    const Local p = local(minimum.x, own);
    const auto add_axis = [&](const auto& row_at, std::vector<double> predicted) {
      for (std::size_t i = 0; i < flight.size(); ++i) {
        predicted[i] += row_at(samples[f].all[i], k, p).residual;
      }
      for (std::size_t i = 1; i + 1 < flight.size(); ++i) {
        const double before = flight.time[i] - flight.time[i - 1];
        const double after = flight.time[i + 1] - flight.time[i];
        if (before > 2 * after || after > 2 * before) continue;
        const double error = (predicted[i - 1] - 2 * predicted[i] + predicted[i + 1]) / 6;
        pull(own) += error * row_at(samples[f].all[i], k, p).slopes.head(Index(own.size()));
      }
    };
    add_axis(forward_row, flight.forward_acceleration);
    if (samples[f].both_axes) add_axis(right_row, flight.right_acceleration);
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

const FittedParameter* DragFit::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

const FittedParameter* DragFit::find(std::string_view name, std::size_t flight) const {
  return find(wind().size() > 1 ? fmt::format("{}[{}]", name, flight) : std::string(name));
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

  const std::vector<Samples> samples = samples_of(flights, conditions.gravity);
  const Places places(samples);
  const double k = conditions.air_density / (2 * conditions.mass);
  const Box within = box(options.bounds, places);

  VectorXd start;
  if (options.start) {
    start = VectorXd::Zero(places.size);
    start.head<shared>() << options.start->front_area, options.start->top_area,
        options.start->linear_speed;
    start.segment(shared, static_cast<Index>(flights.size())) =
        Eigen::Map<const VectorXd>(options.start->wind.data(), static_cast<Index>(flights.size()));
  } else {
    start = joint_start(samples, k, options.bounds, places);
  }
  if (places.areas.size() > 2) start(places.areas[2]) = start(front);
  const Minimum minimum = minimise(samples, k, start, places, within);
  const auto names = parameter_names(places);
  demand_drag(minimum.x);
  demand_separate_effects(minimum, names);

  DragFit fit;
  fit.conditions = conditions;
  fit.iterations = minimum.iterations;
  fit.converged = minimum.converged;

  const MatrixXd inverse = free_inverse(minimum);
  const VectorXd undone = differentiation_correction(flights, samples, k, minimum, places, inverse);
  fit.differentiation_correction.assign(undone.data(), undone.data() + undone.size());

  // Residual statistics and the honest covariance, flight by flight.
  const auto size = minimum.x.size();
  FitQuality& quality = fit.quality;
  std::vector<double> drags;  // of all rows
  for (const auto& flight : samples) {
    quality.samples += flight.size();
    fit.wind_heading.push_back(flight.wind_heading);
    for (const Sample& s : flight.all) {
      drags.push_back(s.forward.observed);
      if (flight.both_axes) drags.push_back(s.right.observed);
    }
  }
  const auto count = static_cast<double>(drags.size());
  const double correction = count / (count - static_cast<double>(minimum.free.size()));
  for (std::size_t f = 0; f < samples.size(); ++f) {
    const std::vector<Index>& own = places.of_flight[f];
    const Local p = local(minimum.x, own);
    const Scores scores = scores_of(samples[f], k, p, own.size());
    const auto length = static_cast<double>(samples[f].size());
    const double effective = effective_sample_size(scores.residuals);
    const std::size_t terms = cosine_terms(length, effective);
    const auto omega = long_run_covariance(scores.rows, own.size(), terms);

    MatrixXd middle = MatrixXd::Zero(size, size);
    const auto columns = static_cast<Index>(own.size());
    middle(own, own) = Eigen::Map<const MatrixXd>(omega.data(), columns, columns) * length;
    fit.covariance_by_flight.push_back(
        flatten(product(product(inverse, middle), inverse) * correction));
    fit.degrees_of_freedom_by_flight.push_back(static_cast<double>(terms));

    for (const std::vector<double>* residuals : {&scores.residuals, &scores.right_residuals}) {
      if (residuals->empty()) continue;
      quality.effective_samples += effective_sample_size(*residuals);
      quality.residual_lag1_autocorrelation += autocorrelation(*residuals, 1) * length / count;
      for (double r : *residuals) quality.mae += std::abs(r) / count;
    }
    for (const Sample& s : samples[f].all) {
      fit.max_airspeed = std::max(fit.max_airspeed, std::abs(airspeed(s, p).ahead));
    }
  }
  const double mean = std::accumulate(drags.begin(), drags.end(), 0.0) / count;
  double sum_of_squares = 0;
  for (const double drag : drags) sum_of_squares += (drag - mean) * (drag - mean);
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

std::vector<DragAtSample> drag_at_samples(const DragFit& fit,
                                          std::span<const Observations> flights) {
  const DragFitConditions& known = fit.conditions;
  const std::vector<Samples> samples = samples_of(flights, known.gravity);
  const Places places(samples);
  if (flights.size() != fit.wind().size() || std::size_t(places.size) != fit.parameters.size()) {
    throw std::invalid_argument("the flights are not those that the drag was fitted to");
  }
  VectorXd x(places.size);
  for (Index i = 0; i < places.size; ++i) {
    x(i) = fit.parameters[static_cast<std::size_t>(i)].estimate.value;
  }
  const double k = known.air_density / (2 * known.mass);
  std::vector<DragAtSample> out;
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const Local p = local(x, places.of_flight[f]);
    for (std::size_t i = 0; i < samples[f].size(); ++i) {
      const Sample& s = samples[f].all[i];
      const double observed = s.forward.observed;
      out.push_back({airspeed(s, p).ahead, flights[f].tilt[i], known.mass * observed,
                     known.mass * (observed - forward_row(s, k, p).residual)});
    }
  }
  return out;
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
      airframe_drag_slopes(drag, density, airspeed, 0, 1 / secant, t / secant);
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

}  // namespace tethercalc
