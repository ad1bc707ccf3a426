#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

// Eigen's solvers for dense matrices of doubles, compiled once in dense_solvers.cpp: the
// eigen-solvers take the compiler ten seconds in each source that uses them. Include this instead
// of the headers above, and give the solvers a MatrixXd: what takes an expression is compiled where
// it stands.

namespace Eigen {

extern template class SelfAdjointEigenSolver<MatrixXd>;
extern template SelfAdjointEigenSolver<MatrixXd>&
SelfAdjointEigenSolver<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&, int);
extern template class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
extern template class EigenSolver<MatrixXd>;
extern template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute<MatrixXd>(
    const EigenBase<MatrixXd>&, bool);
extern template class LLT<MatrixXd>;
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&);
extern template class PartialPivLU<MatrixXd>;
extern template class HouseholderQR<MatrixXd>;
extern template class ColPivHouseholderQR<MatrixXd>;

}  // namespace Eigen
