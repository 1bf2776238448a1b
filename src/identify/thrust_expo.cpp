// Notation: a place within the spin range, T = b₀ + b₁·a + b₂·a², e = b₂/(b₁ + b₂).
#include "tethercalc/identify/thrust_expo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/linear_algebra.hpp"
#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t fewest_rows = 5;
constexpr double least_cover = 0.5;
constexpr double largest_expo = 1;  // of the documented range, −1 to 1
// Half of an interval: one over half of that range says less than ArduPilot's default.
constexpr double widest = 0.5;

/// Places within the range, and thrusts.
struct PlacedRows {
  VectorXd place;
  VectorXd thrust;
};

PlacedRows within(std::span<const ThrottledThrust> rows, const SpinRange& range) {
  std::vector<ThrottledThrust> kept;
  std::ranges::copy_if(rows, std::back_inserter(kept), [&](const ThrottledThrust& row) {
    return row.output >= range.least && row.output <= range.most;
  });
  const auto count = static_cast<Index>(kept.size());
  PlacedRows out{VectorXd(count), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    const ThrottledThrust& row = kept[static_cast<std::size_t>(i)];
    out.place[i] = (row.output - range.least) / (range.most - range.least);
    out.thrust[i] = row.thrust;
  }
  return out;
}

void check_rows(const PlacedRows& rows, const SpinRange& range) {
  const auto count = static_cast<std::size_t>(rows.place.size());
  const double cover = count == 0 ? 0 : rows.place.maxCoeff() - rows.place.minCoeff();
  if (count >= fewest_rows && cover >= least_cover) return;
  throw UnsuitableThrottle(
      fmt::format("{} rows lie between MOT_SPIN_MIN {:g} and MOT_SPIN_MAX {:g}, over {:.0f} % of "
                  "the way; {} over {:.0f} % are needed",
                  count, range.least, range.most, 100 * cover, fewest_rows, 100 * least_cover));
}

/// The powers 0 to `degree` of the places.
MatrixXd powers_of(const VectorXd& place, int degree) {
  MatrixXd out = MatrixXd::Ones(place.size(), degree + 1);
  for (int k = 1; k <= degree; ++k) out.col(k) = out.col(k - 1).cwiseProduct(place);
  return out;
}

double squares_left(const MatrixXd& powers, const VectorXd& thrust) {
  return left_by(powers, thrust).squaredNorm();
}

}  // namespace

ThrustExpo fit_thrust_expo(std::span<const ThrottledThrust> rows, const SpinRange& range) {
  const PlacedRows placed = within(rows, range);
  check_rows(placed, range);
  const MatrixXd powers = powers_of(placed.place, 2);
  const VectorXd b = least_squares(powers, placed.thrust);
  const double rise = b[1] + b[2];
  if (!(rise > 0)) throw UnsuitableThrottle("thrust does not rise with throttle");
  const auto count = static_cast<double>(placed.place.size());
  const double squares = (placed.thrust - powers * b).squaredNorm();

  ThrustExpo out;
  Estimate& expo = out.expo;
  expo.value = b[2] / rise;
  expo.degrees_of_freedom = count - 3;
  const Eigen::Vector3d gradient(0, -b[2] / (rise * rise), b[1] / (rise * rise));
  const VectorXd solved = solve_symmetric(gram_matrix(powers), gradient);
  expo.standard_error_independent =
      std::sqrt(squares / expo.degrees_of_freedom * gradient.dot(solved));
  expo.standard_error = expo.standard_error_independent;
  const double half_width = student_quantile(expo.degrees_of_freedom, 0.975) * expo.standard_error;
  expo.lower = expo.value - half_width;
  expo.upper = expo.value + half_width;
  constexpr double rounding = 1e-9;
  if (expo.lower > largest_expo + rounding || expo.upper < -largest_expo - rounding) {
    throw UnsuitableThrottle(
        fmt::format("MOT_THST_EXPO would be {:.3g}, outside its range of -1 to 1: thrust over "
                    "throttle has another shape than ArduPilot's curve",
                    expo.value));
  }
  if (!(half_width <= widest)) {
    throw UnsuitableThrottle(fmt::format(
        "the rows tell MOT_THST_EXPO only to within {:.2f} to {:.2f} (95 %): they scatter too much",
        expo.lower, expo.upper));
  }
  expo.value = std::clamp(expo.value, -largest_expo, largest_expo);
  out.idle_thrust = b[0];
  out.full_thrust = b[0] + rise;
  out.scatter = std::sqrt(squares / count) / rise;
  out.left_unbent =
      std::sqrt(squares_left(powers_of(placed.place, 1), placed.thrust) / count) / rise;
  out.rows = static_cast<std::size_t>(placed.place.size());
  return out;
}

}  // namespace tethercalc
