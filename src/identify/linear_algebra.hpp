// Decompositions that more than one file needs: they take long to compile.
#pragma once

#include <Eigen/Core>

namespace tethercalc {

/// x of the least ‖a·x − b‖, for every column of `b`.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// x of matrix·x = b for a symmetric matrix without negative eigenvalues, for every column of `b`.
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix,
                                              const Eigen::MatrixXd& b);

/// The least eigenvalue of a symmetric matrix, and its direction of length 1.
struct LeastEigenvalue {
  double value = 0;
  Eigen::VectorXd direction;
};
[[nodiscard]] LeastEigenvalue least_eigenvalue(const Eigen::MatrixXd& symmetric);

/// Moore and Penrose's inverse of a symmetric matrix without negative eigenvalues. Those within
/// rounding of the largest count as zero.
[[nodiscard]] Eigen::MatrixXd symmetric_pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace tethercalc
