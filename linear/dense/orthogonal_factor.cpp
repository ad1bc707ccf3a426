#include "linear/dense/orthogonal_factor.hpp"

namespace chladni::linear {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

MatrixXd columns_of_Q(const Eigen::HouseholderQR<MatrixXd>& qr, Index n)
{
  return qr.householderQ() * MatrixXd::Identity(qr.rows(), n);
}

MatrixXd columns_of_Q(const Eigen::ColPivHouseholderQR<MatrixXd>& qr, Index n)
{
  return qr.householderQ() * MatrixXd::Identity(qr.rows(), n);
}

MatrixXcd columns_of_Q(const Eigen::HouseholderQR<MatrixXcd>& qr, Index n)
{
  return qr.householderQ() * MatrixXcd::Identity(qr.rows(), n);
}

MatrixXd least_squares(const MatrixXd& A, const MatrixXd& B)
{
  return A.completeOrthogonalDecomposition().solve(B);
}

}  // namespace chladni::linear
