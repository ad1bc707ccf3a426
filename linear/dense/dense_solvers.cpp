#include "linear/dense/dense_solvers.hpp"

#include <algorithm>
#include <limits>

namespace Eigen {

template class SelfAdjointEigenSolver<MatrixXd>;
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute<MatrixXd>(
    const EigenBase<MatrixXd>&, int);
template class SelfAdjointEigenSolver<MatrixXcd>;
template SelfAdjointEigenSolver<MatrixXcd>& SelfAdjointEigenSolver<MatrixXcd>::compute<MatrixXcd>(
    const EigenBase<MatrixXcd>&, int);
template class GeneralizedSelfAdjointEigenSolver<MatrixXd>;

template class EigenSolver<MatrixXd>;
template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&,
                                                                         bool);
template class ComplexEigenSolver<MatrixXcd>;
template ComplexEigenSolver<MatrixXcd>& ComplexEigenSolver<MatrixXcd>::compute<MatrixXcd>(
    const EigenBase<MatrixXcd>&, bool);

template class JacobiSVD<MatrixXd>;

template class LLT<MatrixXd>;
template LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&);
template class PartialPivLU<MatrixXd>;
template class PartialPivLU<MatrixXcd>;
template class HouseholderQR<MatrixXd>;
template class HouseholderQR<MatrixXcd>;
template class ColPivHouseholderQR<MatrixXd>;
template class CompleteOrthogonalDecomposition<MatrixXd>;

}  // namespace Eigen

namespace chladni::linear {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

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

double condition_number(const Eigen::MatrixXd& A)
{
  if (A.size() == 0) return 1.0;
  constexpr Eigen::Index few = 64;
  const Eigen::VectorXd s = std::min(A.rows(), A.cols()) <= few
                                ? Eigen::JacobiSVD<Eigen::MatrixXd>(A).singularValues()
                                : Eigen::BDCSVD<Eigen::MatrixXd>(A).singularValues();
  const double least = s[s.size() - 1];
  return least > 0.0 ? s[0] / least : std::numeric_limits<double>::infinity();
}

}  // namespace chladni::linear
