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
