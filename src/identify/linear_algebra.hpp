// Names of linear algebra, and the products and decompositions that more than one file needs. They
// take long to compile, products anew for every kind of operand: here all are matrices in memory.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace tethercalc {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Series = Eigen::ArrayXd;

/// For arithmetic; refers to the vector.
[[nodiscard]] inline Eigen::Map<const Series> as_series(const std::vector<double>& x) {
  return {x.data(), static_cast<Index>(x.size())};
}
[[nodiscard]] inline Eigen::Map<Series> as_series(std::vector<double>& x) {
  return {x.data(), static_cast<Index>(x.size())};
}

/// A matrix or some of its neighbouring rows and columns; of other expressions a copy.
using MatrixView = Eigen::Ref<const MatrixXd>;
using VectorView = Eigen::Ref<const VectorXd>;

/// a·b.
[[nodiscard]] MatrixXd product(const MatrixView& a, const MatrixView& b);
/// aᵀ·b: of every column with every column.
[[nodiscard]] MatrixXd inner_products(const MatrixView& a, const MatrixView& b);
[[nodiscard]] VectorXd inner_products_with(const MatrixView& a, const VectorView& vector);
/// aᵀ·a.
[[nodiscard]] MatrixXd gram_matrix(const MatrixView& a);

/// x of the least ‖a·x − b‖, for every column of `b`.
[[nodiscard]] MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b);

/// What that leaves of `b`: b − a·x.
[[nodiscard]] MatrixXd left_by(const MatrixXd& a, const MatrixXd& b);

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
/// That inverse times `b`.
[[nodiscard]] VectorXd pseudo_solution(const MatrixXd& matrix, const VectorXd& b);

}  // namespace tethercalc
