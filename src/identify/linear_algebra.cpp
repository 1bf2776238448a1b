#include "identify/linear_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <limits>

namespace tethercalc {

MatrixXd product(const MatrixView& a, const MatrixView& b) { return a * b; }

MatrixXd inner_products(const MatrixView& a, const MatrixView& b) { return a.transpose() * b; }

VectorXd inner_products_with(const MatrixView& a, const VectorView& vector) {
  return a.transpose() * vector;
}

MatrixXd gram_matrix(const MatrixView& a) { return inner_products(a, a); }

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd left_by(const MatrixXd& a, const MatrixXd& b) {
  return b - product(a, least_squares(a, b));
}

MatrixXd solve_symmetric(const MatrixXd& matrix, const MatrixXd& b) {
  return matrix.ldlt().solve(b);
}

LeastEigenvalue least_eigenvalue(const MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(symmetric);  // in rising order
  return {eigen.eigenvalues()[0], eigen.eigenvectors().col(0)};
}

MatrixXd symmetric_pseudo_inverse(const MatrixXd& matrix) {
  if (matrix.size() == 0) return matrix;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(matrix);
  const VectorXd& values = eigen.eigenvalues();
  const double least = values.cwiseAbs().maxCoeff() * static_cast<double>(matrix.rows()) *
                       std::numeric_limits<double>::epsilon();
  const VectorXd inverse = (values.array() > least).select(values.array().inverse(), 0);
  return product(eigen.eigenvectors() * inverse.asDiagonal(), eigen.eigenvectors().transpose());
}

VectorXd pseudo_solution(const MatrixXd& matrix, const VectorXd& b) {
  return symmetric_pseudo_inverse(matrix) * b;
}

}  // namespace tethercalc
