#include "linear/dense/dense_solvers.hpp"

namespace Eigen {

template class SelfAdjointEigenSolver<MatrixXd>;
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute<MatrixXd>(
    const EigenBase<MatrixXd>&, int);
template class SelfAdjointEigenSolver<MatrixXcd>;
template SelfAdjointEigenSolver<MatrixXcd>& SelfAdjointEigenSolver<MatrixXcd>::compute<MatrixXcd>(
    const EigenBase<MatrixXcd>&, int);
template class GeneralizedSelfAdjointEigenSolver<MatrixXd>;

}  // namespace Eigen
