#include "identify/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "identify/linear_algebra.hpp"

namespace tethercalc {
namespace {

// Long double takes three times as long to compile, for digits nobody sees.
// Boost's functions call each other with this order of both, so that each is compiled once.
using Plain = boost::math::policies::policy<boost::math::policies::promote_float<false>,
                                            boost::math::policies::promote_double<false>>;

template <class Distribution>
double tail(const Distribution& distribution, double value) {
  return boost::math::cdf(boost::math::complement(distribution, value));
}

/// The series less its mean.
VectorXd centred(std::span<const double> series) {
  const auto x = VectorXd::Map(series.data(), static_cast<Index>(series.size()));
  return x.array() - x.mean();
}

/// Σ x_t·x_{t+lag}.
double lagged_product(const VectorXd& x, Index lag) {
  return x.head(x.size() - lag).dot(x.tail(x.size() - lag));
}

}  // namespace

std::vector<double> distance_from_neighbours(const std::vector<double>& series, std::size_t half) {
  const std::size_t size = 2 * half + 1;
  std::vector<double> distance(series.size(), 0);
  if (series.size() < size) return distance;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::size_t begin = std::min(i < half ? 0 : i - half, series.size() - size);
    const auto first = series.begin() + static_cast<std::ptrdiff_t>(begin);
    distance[i] = std::abs(series[i] - median({first, first + static_cast<std::ptrdiff_t>(size)}));
  }
  return distance;
}

double student_quantile(double degrees, double p) {
  // By the tail, which is there anyhow: Boost's own inverse is 20 kB of the page's program.
  const double beyond = std::min(p, 1 - p);
  const auto excess = [&](double t) { return student_tail(t, degrees) - beyond; };
  double far = 1;
  while (excess(far) > 0) far *= 2;
  std::uintmax_t steps = 200;
  const auto [below, above] = boost::math::tools::toms748_solve(
      excess, 0.0, far, boost::math::tools::eps_tolerance<double>(52), steps, Plain());
  const double t = (below + above) / 2;
  return p < 0.5 ? -t : t;
}

double student_tail(double t, double degrees) {
  if (!std::isfinite(t)) return t > 0 ? 0 : 1;
  return tail(boost::math::students_t_distribution<double, Plain>(degrees), t);
}

double fisher_tail(double f, double numerator, double denominator) {
  if (!std::isfinite(f)) return 0;
  return tail(boost::math::fisher_f_distribution<double, Plain>(numerator, denominator),
              std::max(f, 0.0));
}

double chi_squared_tail(double x, double degrees) {
  return tail(boost::math::chi_squared_distribution<double, Plain>(degrees), std::max(x, 0.0));
}

double autocorrelation(std::span<const double> series, std::size_t lag) {
  if (series.size() <= lag) return 0;
  const VectorXd x = centred(series);
  const double variance = x.squaredNorm();
  return variance > 0 ? lagged_product(x, static_cast<Index>(lag)) / variance : 0;
}

double effective_sample_size(std::span<const double> series) {
  const auto size = static_cast<double>(series.size());
  if (series.size() < 2) return size;
  const VectorXd x = centred(series);
  const double variance = x.squaredNorm();
  if (!(variance > 0)) return size;
  double correlation_time = -1;  // −1 + 2·Σ of the pairs, the first of which holds ρ_0 = 1
  for (Index lag = 0; lag + 1 < x.size(); lag += 2) {
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
  const auto width = static_cast<Index>(columns);
  const auto height = static_cast<Index>(rows.size() / columns);
  const auto count = static_cast<Index>(terms);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> z(
      rows.data(), height, width);

  // All cosines advance together by cos(a + d) = 2cos(d)cos(a) − cos(a − d), one cosine a term
  // instead of one a sample and term. The recurrence's error grows no faster than N²·ε: 3e-7
  // for an hour at 10 Hz, far below the 1/√ν by which the estimate itself scatters.
  const double unit_step = std::numbers::pi / static_cast<double>(height);
  const Eigen::ArrayXd steps =
      Eigen::ArrayXd::LinSpaced(count, 1.0, static_cast<double>(terms)) * unit_step;
  const Eigen::ArrayXd twice_cosine = 2 * steps.cos();

  // In blocks of samples, so that the sums are matrix products.
  constexpr Index block = 64;
  Eigen::ArrayXXd cosines(count, block);
  cosines.col(block - 2) = (1.5 * steps).cos();  // those before the first sample: cos is even
  cosines.col(block - 1) = (0.5 * steps).cos();
  MatrixXd coefficients = MatrixXd::Zero(count, width);
  for (Index t = 0; t < height; t += block) {
    const Index length = std::min(block, height - t);
    for (Index i = 0; i < length; ++i) {
      const Index one_before = (i + block - 1) % block;
      const Index two_before = (i + block - 2) % block;
      cosines.col(i) = twice_cosine * cosines.col(one_before) - cosines.col(two_before);
    }
    coefficients += product(cosines.leftCols(length).matrix(), z.middleRows(t, length));
  }
  const MatrixXd covariance =
      gram_matrix(coefficients) * (2 / static_cast<double>(height) / static_cast<double>(terms));
  return {covariance.data(), covariance.data() + covariance.size()};
}

}  // namespace tethercalc
