#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

// Eigen's solvers for dense matrices of doubles and of complex numbers, compiled once in
// symmetric_eigenvalues.cpp, general_eigenvalues.cpp, singular_values.cpp and dense_factors.cpp:
// they take the compiler five to ten seconds in each source that uses them. Include this instead of
// the headers above, and give the solvers a MatrixXd: what takes an expression is compiled where it
// stands. Singular values are those by Jacobi's rotations.

namespace Eigen {

extern template class SelfAdjointEigenSolver<MatrixXd>;
extern template SelfAdjointEigenSolver<MatrixXd>&
SelfAdjointEigenSolver<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&, int);
extern template class SelfAdjointEigenSolver<MatrixXcd>;
extern template SelfAdjointEigenSolver<MatrixXcd>&
SelfAdjointEigenSolver<MatrixXcd>::compute<MatrixXcd>(const EigenBase<MatrixXcd>&, int);
extern template class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
extern template class EigenSolver<MatrixXd>;
extern template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute<MatrixXd>(
    const EigenBase<MatrixXd>&, bool);
extern template class ComplexEigenSolver<MatrixXcd>;
extern template ComplexEigenSolver<MatrixXcd>& ComplexEigenSolver<MatrixXcd>::compute<MatrixXcd>(
    const EigenBase<MatrixXcd>&, bool);
extern template class LLT<MatrixXd>;
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&);
extern template class PartialPivLU<MatrixXd>;
extern template class PartialPivLU<MatrixXcd>;
extern template class HouseholderQR<MatrixXd>;
extern template class HouseholderQR<MatrixXcd>;
extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template class JacobiSVD<MatrixXd>;

}  // namespace Eigen

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

/// The largest singular value over the least one, infinite where that vanishes; 1 of an empty
/// matrix. Up to 64 columns by Jacobi's rotations, more by a bidiagonal form, which takes a
/// hundredth of their time with a thousand.
double condition_number(const Eigen::MatrixXd& A);

}  // namespace chladni::linear
