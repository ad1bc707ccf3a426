#include "linear/dense/dense_solvers.hpp"

namespace Eigen {

template class EigenSolver<MatrixXd>;
template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&,
                                                                         bool);
template class ComplexEigenSolver<MatrixXcd>;
template ComplexEigenSolver<MatrixXcd>& ComplexEigenSolver<MatrixXcd>::compute<MatrixXcd>(
    const EigenBase<MatrixXcd>&, bool);

}  // namespace Eigen
