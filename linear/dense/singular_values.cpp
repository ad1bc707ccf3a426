#include "linear/dense/dense_solvers.hpp"

namespace Eigen {

template class JacobiSVD<MatrixXd>;

}  // namespace Eigen
