// Names of linear algebra, and the decompositions that more than one file needs: they take long to
// compile.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace tethercalc {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Series = Eigen::ArrayXd;

/// For arithmetic.
[[nodiscard]] inline Series as_series(const std::vector<double>& x) {
  return Series::Map(x.data(), static_cast<Index>(x.size()));
}

/// x of the least ‖a·x − b‖, for every column of `b`.
[[nodiscard]] MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b);

/// x of matrix·x = b for a symmetric matrix without negative eigenvalues, for every column of `b`.
[[nodiscard]] MatrixXd solve_symmetric(const MatrixXd& matrix, const MatrixXd& b);

/// The least eigenvalue of a symmetric matrix, and its direction of length 1.
struct LeastEigenvalue {
  double value = 0;
  VectorXd direction;
};
[[nodiscard]] LeastEigenvalue least_eigenvalue(const MatrixXd& symmetric);

/// Moore and Penrose's inverse of a symmetric matrix without negative eigenvalues. Those within
/// rounding of the largest count as zero.
[[nodiscard]] MatrixXd symmetric_pseudo_inverse(const MatrixXd& matrix);

}  // namespace tethercalc
