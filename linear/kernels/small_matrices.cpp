#include "linear/kernels/small_matrices.hpp"

#include <petscblaslapack.h>

#include <vector>

#include "common/error.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

MatrixXd product(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd C = MatrixXd::Zero(A.rows(), B.cols());
  add_product(1.0, A.data(), static_cast<PetscInt>(A.rows()), B, 0.0, C.data());
  return C;
}

MatrixXd solution(MatrixXd A, MatrixXd B)
{
  const auto n = static_cast<PetscBLASInt>(A.rows()), m = static_cast<PetscBLASInt>(B.cols());
  if (n == 0 || m == 0) return B;
  std::vector<PetscBLASInt> pivots(static_cast<std::size_t>(n));
  PetscBLASInt info = 0;
  LAPACKgesv_(&n, &m, A.data(), &n, pivots.data(), B.data(), &n, &info);
  if (info != 0) throw Error(fmt::format("solution: the matrix is singular at row {}", info));
  return B;
}

MatrixXd stacked(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd C(A.rows() + B.rows(), B.cols());
  C.topRows(A.rows()) = A;
  C.bottomRows(B.rows()) = B;
  return C;
}

void add_product(double alpha, const double* X, PetscInt n_local, const MatrixXd& S, double beta,
                 double* Y)
{
  const PetscBLASInt m = n_local;
  const auto n = static_cast<PetscBLASInt>(S.cols()), k = static_cast<PetscBLASInt>(S.rows());
  if (m == 0 || n == 0 || k == 0) return;
  BLASgemm_("N", "N", &m, &n, &k, &alpha, X, &m, S.data(), &k, &beta, Y, &m);
}

}  // namespace chladni::linear
