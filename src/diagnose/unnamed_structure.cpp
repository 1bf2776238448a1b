#include "diagnose/unnamed_structure.hpp"

#include <algorithm>
#include <cmath>

#include "identify/distributions.hpp"
#include "identify/linear_algebra.hpp"
#include "identify/series.hpp"

namespace tethercalc {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A regressor of which less than this part of the sum of squares is its own, the rest being a
/// combination of what the fit contains, would only add noise.
constexpr double least_own_part = 1e-3;

/// Sums over one block; all that a linear extension of the fit needs.
struct BlockSums {
  MatrixXd normal;    ///< JᵀJ
  VectorXd gradient;  ///< Jᵀr
  MatrixXd cross;     ///< JᵀZ
  VectorXd own;       ///< Σz² of each regressor
  VectorXd slope;     ///< Σz·r
  double squared_residual = 0;
};

MatrixXd regressor_columns(const Record& record) {
  const auto& unnamed = record.problem().unnamed;
  MatrixXd columns(record.rows(), static_cast<Index>(unnamed.size()));
  for (std::size_t k = 0; k < unnamed.size(); ++k) {
    columns.col(static_cast<Index>(k)) = record.scaled_column(unnamed[k].column);
  }
  return columns;
}

/// Robustness weights count in the fits, not in the held-out error.
BlockSums sums(const Record& record, const BlockFit& fit, const MatrixXd& columns,
               std::size_t block, bool weighted) {
  const auto rows = Eigen::seqN(record.block_begin(block), record.block_size(block));
  const MatrixXd jacobian = fit.jacobian(rows, Eigen::all);
  const MatrixXd z = columns(rows, Eigen::all);
  const VectorXd residual = fit.residual(rows);
  VectorXd weight = VectorXd::Ones(residual.size());
  if (weighted) weight = fit.weight(rows);
  BlockSums s;
  s.normal = jacobian.transpose() * weight.asDiagonal() * jacobian;
  s.gradient = jacobian.transpose() * weight.cwiseProduct(residual);
  s.cross = jacobian.transpose() * weight.asDiagonal() * z;
  s.own = z.array().square().matrix().transpose() * weight;
  s.slope = z.transpose() * weight.cwiseProduct(residual);
  s.squared_residual = residual.squaredNorm();
  return s;
}

void add(BlockSums& total, const BlockSums& part, double sign) {
  total.normal += sign * part.normal;
  total.gradient += sign * part.gradient;
  total.cross += sign * part.cross;
  total.own += sign * part.own;
  total.slope += sign * part.slope;
}

}  // namespace

std::optional<UnnamedTrial> best_unnamed(const Record& record, const BlockFit& fit,
                                         const std::vector<std::size_t>& taken,
                                         double false_alarm_probability) {
  const auto count = static_cast<Index>(record.problem().unnamed.size());
  if (count == 0) return std::nullopt;
  const MatrixXd columns = regressor_columns(record);
  const auto blocks = static_cast<Index>(record.blocks());

  std::vector<BlockSums> held_out;
  std::vector<BlockSums> fitted;
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    held_out.push_back(sums(record, fit, columns, b, false));
    fitted.push_back(sums(record, fit, columns, b, true));
  }
  BlockSums total = fitted.front();
  for (std::size_t b = 1; b < record.blocks(); ++b) add(total, fitted[b], 1);

  MatrixXd coefficient(blocks, count);
  MatrixXd error(blocks, count);
  VectorXd own_part = VectorXd::Ones(count);
  for (Index b = 0; b < blocks; ++b) {
    BlockSums rest = total;
    add(rest, fitted[static_cast<std::size_t>(b)], -1);
    const BlockSums& out = held_out[static_cast<std::size_t>(b)];
    const Index size = rest.normal.rows();
    MatrixXd along = MatrixXd::Zero(size, count);  // (JᵀJ)⁻¹JᵀZ
    VectorXd step = VectorXd::Zero(size);
    if (size > 0) {
      along = solve_symmetric(rest.normal, rest.cross);
      step = solve_symmetric(rest.normal, rest.gradient);
    }
    for (Index k = 0; k < count; ++k) {
      const double own = rest.own[k] - rest.cross.col(k).dot(along.col(k));
      own_part[k] = std::min(own_part[k], rest.own[k] > 0 ? own / rest.own[k] : 0);
      if (own_part[k] < least_own_part) continue;
      const double beta = (rest.slope[k] - rest.cross.col(k).dot(step)) / own;
      const VectorXd delta = step - along.col(k) * beta;
      coefficient(b, k) = beta;
      error(b, k) = out.squared_residual + delta.dot(out.normal * delta) +
                    beta * beta * out.own[k] - 2 * (delta.dot(out.gradient) + beta * out.slope[k]) +
                    2 * beta * delta.dot(out.cross.col(k));
    }
  }

  const auto degrees = static_cast<double>(blocks - 1);
  const double threshold =
      -student_quantile(degrees, false_alarm_probability / 2 / static_cast<double>(count));
  std::optional<Index> best;
  for (Index k = 0; k < count; ++k) {
    if (own_part[k] < least_own_part || contains(taken, static_cast<std::size_t>(k))) continue;
    const VectorXd values = coefficient.col(k);
    const double mean = values.mean();
    const double se =
        std::sqrt(degrees / static_cast<double>(blocks) * (values.array() - mean).square().sum());
    if (!(std::abs(mean) > threshold * se)) continue;
    if (!best || error.col(k).sum() < error.col(*best).sum()) best = k;
  }
  if (!best) return std::nullopt;
  return UnnamedTrial{static_cast<std::size_t>(*best), error.col(*best)};
}

}  // namespace tethercalc
