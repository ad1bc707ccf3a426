#pragma once

#include "linear/dense/dense_solvers.hpp"

namespace chladni::linear {

/// The first columns of the orthogonal factor Q of a QR decomposition. The product of Householder's
/// reflections takes the compiler ten seconds in each source, and so does a least-squares solution:
/// here they are compiled once.
/// @param n  how many columns, at most as many as the decomposed matrix has rows
/// @return [rows x n]
Eigen::MatrixXd columns_of_Q(const Eigen::HouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index n);
Eigen::MatrixXd columns_of_Q(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index n);
Eigen::MatrixXcd columns_of_Q(const Eigen::HouseholderQR<Eigen::MatrixXcd>& qr, Eigen::Index n);

/// The X of least norm that minimises |A X - B|; A may lack rank.
/// @param A  [m x n]  @param B  [m x k]
/// @return [n x k]
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace chladni::linear
