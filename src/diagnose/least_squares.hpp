// Decompositions that more than one file needs: they take long to compile.
#pragma once

#include <Eigen/Core>

namespace tethercalc {

/// x of the least ‖a·x − b‖, for every column of `b`.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Moore and Penrose's inverse of a symmetric matrix without negative eigenvalues. Those within
/// rounding of the largest count as zero.
[[nodiscard]] Eigen::MatrixXd symmetric_pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace tethercalc
