// Robust nonlinear least squares whose errors and held-out predictions come from leaving out
// blocks.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "diagnose/selection.hpp"
#include "identify/linear_algebra.hpp"

namespace tethercalc {

/// The rows of a SelectionProblem that belong to a block, divided by their noise, and ordered by
/// block so that each block is a contiguous segment.
class Record {
 public:
  /// Keeps references: `problem` must outlive it.
  explicit Record(const SelectionProblem& problem);

  [[nodiscard]] Index rows() const { return static_cast<Index>(rows_.size()); }
  [[nodiscard]] std::size_t blocks() const { return block_begin_.size() - 1; }
  [[nodiscard]] Index block_begin(std::size_t b) const { return block_begin_[b]; }
  [[nodiscard]] Index block_size(std::size_t b) const {
    return block_begin_[b + 1] - block_begin_[b];
  }
  [[nodiscard]] const std::vector<ModelParameter>& parameters() const { return parameters_; }
  /// Fits that free the parameter begin with this value, within its bounds.
  void start_at(std::size_t parameter, double value) { parameters_[parameter].start = value; }
  /// First parameter of a group.
  [[nodiscard]] std::size_t first_parameter(std::size_t group) const { return first_[group]; }
  [[nodiscard]] const SelectionProblem& problem() const { return problem_; }
  [[nodiscard]] std::size_t row_in_problem(Index i) const {
    return rows_[static_cast<std::size_t>(i)];
  }

  /// (measured − predicted)/noise.
  void residuals(const std::vector<double>& values, VectorXd& out) const;
  /// A column over the problem's rows, divided by the noise.
  [[nodiscard]] VectorXd scaled_column(const std::vector<double>& column) const;
  /// The problem's regressors without a name, each so divided.
  [[nodiscard]] const MatrixXd& unnamed_columns() const { return unnamed_columns_; }

 private:
  const SelectionProblem& problem_;
  std::vector<ModelParameter> parameters_;
  std::vector<std::size_t> first_;
  std::vector<std::size_t> rows_;
  std::vector<Index> block_begin_;
  VectorXd inverse_noise_;
  MatrixXd unnamed_columns_;
  mutable std::vector<double> predicted_;
};

/// Indices of groups, or of regressors.
using Groups = std::vector<std::size_t>;

/// `groups` with one more, by rising index.
[[nodiscard]] Groups with_group(Groups groups, std::size_t group);
/// `groups` without one of them.
[[nodiscard]] Groups without_group(Groups groups, std::size_t group);

/// What is free in a fit.
struct Freed {
  Groups groups;   ///< indices into SelectionProblem::groups
  Groups unnamed;  ///< regressors with a free coefficient each
};

/// A fit with everything that the selection asks of it. Columns of `jacobian` are the parameters
/// that are free and not held at a bound, each over its scale, then the unnamed coefficients.
struct BlockFit {
  Freed freed;
  std::vector<double> values;       ///< all parameters
  VectorXd coefficients;            ///< of the unnamed regressors as they are given
  std::vector<std::size_t> active;  ///< parameter of each leading column of the jacobian
  MatrixXd jacobian;                ///< of the prediction
  VectorXd residual;                ///< in sample
  VectorXd weight;                  ///< robustness weights in (0, 1]
  MatrixXd left_out;  ///< change of the jacobian's parameters without block b: column b
  VectorXd holdout_residual;
  VectorXd block_error;  ///< held-out sum of squares, one a block

  [[nodiscard]] double squared_error() const { return block_error.sum(); }
  [[nodiscard]] double rmse() const {
    return std::sqrt(squared_error() / static_cast<double>(residual.size()));
  }
};

/// A search compares fits and ends each where a further step would change no decision; what is
/// reported is taken to the minimum as far as rounding allows, at several times the price.
enum class FitUse { search, report };

/// Levenberg–Marquardt on Huber's loss, then one Gauss–Newton step a block for the fits without it.
/// Starts from the values of `near`, which may be null, for what is free in both, elsewhere from
/// the parameters' own first values.
[[nodiscard]] BlockFit fit_blocks(const Record& record, const Freed& freed, const BlockFit* near,
                                  FitUse use = FitUse::search);

/// Slopes of the prediction by the free parameters of `groups` over their scales, at `values`.
[[nodiscard]] MatrixXd group_slopes(const Record& record, const Groups& groups,
                                    const std::vector<double>& values, FitUse use = FitUse::search);

/// Covariance of some quantities by the delete-a-block jackknife, from their values (up to a
/// constant) without each block: one row a quantity, one column a block.
[[nodiscard]] MatrixXd jackknife_covariance(MatrixXd left_out);

/// Covariance of the parameters `of` (columns of the jacobian) by the delete-a-block jackknife.
[[nodiscard]] MatrixXd jackknife_covariance(const BlockFit& fit, const std::vector<Index>& of);

}  // namespace tethercalc
