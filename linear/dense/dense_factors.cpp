#include "linear/dense/dense_solvers.hpp"

namespace Eigen {

template class LLT<MatrixXd>;
template LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&);
template class PartialPivLU<MatrixXd>;
template class PartialPivLU<MatrixXcd>;
template class HouseholderQR<MatrixXd>;
template class HouseholderQR<MatrixXcd>;
template class ColPivHouseholderQR<MatrixXd>;
template class CompleteOrthogonalDecomposition<MatrixXd>;

}  // namespace Eigen
