#include "tethercalc/identify/correlated_errors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tethercalc {
namespace {

using Vector = Eigen::Map<const Eigen::VectorXd>;

Vector as_vector(std::span<const double> series) {
  return {series.data(), static_cast<Eigen::Index>(series.size())};
}

/// Σ x_t·x_{t+lag}.
double lagged_product(const Eigen::VectorXd& x, Eigen::Index lag) {
  return x.head(x.size() - lag).dot(x.tail(x.size() - lag));
}

}  // namespace

double autocorrelation(std::span<const double> series, std::size_t lag) {
  if (series.size() <= lag) return 0;
  const Eigen::VectorXd x = as_vector(series).array() - as_vector(series).mean();
  const double variance = x.squaredNorm();
  return variance > 0 ? lagged_product(x, static_cast<Eigen::Index>(lag)) / variance : 0;
}

double effective_sample_size(std::span<const double> series) {
  const auto size = static_cast<double>(series.size());
  if (series.size() < 2) return size;
  const Eigen::VectorXd x = as_vector(series).array() - as_vector(series).mean();
  const double variance = x.squaredNorm();
  if (!(variance > 0)) return size;
  double correlation_time = -1;  // −1 + 2·Σ of the pairs, the first of which holds ρ_0 = 1
  for (Eigen::Index lag = 0; lag + 1 < x.size(); lag += 2) {
    const double pair = (lagged_product(x, lag) + lagged_product(x, lag + 1)) / variance;
    if (pair <= 0) break;
    correlation_time += 2 * pair;
  }
  return std::clamp(size / std::max(correlation_time, 1.0), 1.0, size);
}

std::size_t cosine_terms(double samples, double effective_samples) {
  constexpr double reference_worth = (1 - 0.7) / (1 + 0.7);
  const double equivalent = std::min(samples, effective_samples / reference_worth);
  return static_cast<std::size_t>(std::max(1.0, std::round(0.4 * std::pow(equivalent, 2.0 / 3.0))));
}

std::vector<double> long_run_covariance(std::span<const double> rows, std::size_t columns,
                                        std::size_t terms) {
  const auto width = static_cast<Eigen::Index>(columns);
  const auto height = static_cast<Eigen::Index>(rows.size() / columns);
  const auto count = static_cast<Eigen::Index>(terms);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> z(
      rows.data(), height, width);

  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(width, count);
  for (Eigen::Index t = 0; t < height; ++t) {
    // cos((j+1)x) = 2cos(x)cos(jx) − cos((j−1)x): one cosine a row instead of one a term.
    const double angle =
        std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(height);
    const double twice_cosine = 2 * std::cos(angle);
    double before = 1;
    double now = twice_cosine / 2;
    for (Eigen::Index j = 0; j < count; ++j) {
      coefficients.col(j) += now * z.row(t).transpose();
      const double next = twice_cosine * now - before;
      before = now;
      now = next;
    }
  }
  const Eigen::MatrixXd covariance = coefficients * coefficients.transpose() *
                                     (2 / static_cast<double>(height) / static_cast<double>(terms));
  return {covariance.data(), covariance.data() + covariance.size()};
}

}  // namespace tethercalc
