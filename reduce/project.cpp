#include <algorithm>

#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"
#include "reduce/guyan.hpp"

namespace chladni::reduce {

namespace {

constexpr PetscInt block_columns = 64;  // at a time: bounds the memory, enough for dgemm

/// From above in the columns of `to` from first_column on.
void copy_columns(linear::SmallMatrix& to, PetscInt first_column, const linear::SmallMatrix& from)
{
  for (PetscInt j = 0; j < from.n_cols; ++j) {
    for (PetscInt i = 0; i < from.n_rows; ++i) to(i, first_column + j) = from(i, j);
  }
}

void mirror_upper_triangle(linear::SmallMatrix& A)
{
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < j; ++i) A(j, i) = A(i, j);
  }
}

void set_leading_block(linear::SmallMatrix& A, const linear::SmallMatrix& block)
{
  for (PetscInt j = 0; j < block.n_cols; ++j) {
    for (PetscInt i = 0; i < block.n_rows; ++i) A(i, j) = block(i, j);
  }
}

/// Calls with the first and the last + 1 of some columns, block after block.
template <typename Work>
void for_column_blocks(PetscInt n_columns, const Work& work)
{
  for (PetscInt first = 0; first < n_columns; first += block_columns) {
    work(first, std::min(first + block_columns, n_columns));
  }
}

PetscInt n_columns(Mat A)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(A, nullptr, &n));
  return n;
}

/// Psi^T M_ss Psi
linear::SmallMatrix slave_mass(Mat Psi, Mat M_ss)
{
  const PetscInt n_m = n_columns(Psi);
  linear::SmallMatrix Psi_M_Psi(n_m, n_m);
  const linear::SparseProduct product(M_ss);
  for_column_blocks(n_m, [&](PetscInt first, PetscInt last) {
    linear::report_progress(double(first) / n_m);
    const petsc::Matrix M_Psi = linear::uninitialized_dense(M_ss, last - first);
    product.apply(linear::ColumnRange(Psi, first, last), M_Psi);
    // The upper triangle of Psi^T M Psi is enough.
    copy_columns(Psi_M_Psi, first, linear::inner_product(linear::ColumnRange(Psi, 0, last), M_Psi));
  });
  mirror_upper_triangle(Psi_M_Psi);
  return Psi_M_Psi;
}

}  // namespace

linear::SmallMatrix guyan_mass(Mat Psi, const Blocks& M)
{
  const linear::SmallMatrix Psi_M_Psi = slave_mass(Psi, M.ss);
  linear::SmallMatrix M_G = linear::replicate(M.mm);
  const linear::SmallMatrix Psi_M_sm = linear::inner_product_sparse(Psi, M.sm);
  for (PetscInt j = 0; j < M_G.n_cols; ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      const double M_mm = 0.5 * (M_G(i, j) + M_G(j, i));
      M_G(i, j) = M_G(j, i) = M_mm + Psi_M_sm(i, j) + Psi_M_sm(j, i) + Psi_M_Psi(i, j);
    }
  }
  return M_G;
}

linear::SmallMatrix inertial_coupling(Mat Phi, Mat Psi, const Blocks& M)
{
  linear::SmallMatrix P = linear::inner_product_sparse(Phi, M.sm);
  const linear::SparseProduct product(M.ss);
  for_column_blocks(n_columns(Phi), [&](PetscInt first, PetscInt last) {
    const petsc::Matrix M_Phi = linear::uninitialized_dense(M.ss, last - first);
    product.apply(linear::ColumnRange(Phi, first, last), M_Phi);
    const linear::SmallMatrix rows = linear::inner_product(M_Phi, Psi);
    for (PetscInt j = 0; j < P.n_cols; ++j) {
      for (PetscInt k = first; k < last; ++k) P(k, j) += rows(k - first, j);
    }
  });
  return P;
}

ReducedModel join(const GuyanStiffness& K_G, const linear::SmallMatrix& M_G,
                  const linear::SmallMatrix& P, std::vector<double> omega)
{
  const PetscInt n_m = K_G.K.n_rows;
  const auto n_q = static_cast<PetscInt>(omega.size());
  ReducedModel reduced{.K = {n_m + n_q, n_m + n_q},
                       .M = {n_m + n_q, n_m + n_q},
                       .n_masters = n_m,
                       .omega = std::move(omega),
                       .R = K_G.R};
  set_leading_block(reduced.K, K_G.K);
  set_leading_block(reduced.M, M_G);
  for (PetscInt k = 0; k < n_q; ++k) {
    reduced.K(n_m + k, n_m + k) = reduced.omega[k] * reduced.omega[k];
    reduced.M(n_m + k, n_m + k) = 1.0;
    for (PetscInt j = 0; j < n_m; ++j) reduced.M(n_m + k, j) = reduced.M(j, n_m + k) = P(k, j);
  }
  return reduced;
}

ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M)
{
  const GuyanStiffness K_G = guyan_stiffness(Q_CB.Psi, K);
  const linear::SmallMatrix M_G = guyan_mass(Q_CB.Psi, M);
  if (!Q_CB.modes) return join(K_G, M_G, {0, 0}, {});
  return join(K_G, M_G, inertial_coupling(Q_CB.modes->Phi, Q_CB.Psi, M), Q_CB.modes->omega);
}

}  // namespace chladni::reduce
