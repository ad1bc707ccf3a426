#include <algorithm>

#include "reduce/craig_bampton.hpp"
#include "reduce/sparse_product.hpp"

namespace chladni::reduce {

namespace {

constexpr PetscInt block_columns =
    64;  // of M_ss Psi at a time: bounds the memory, enough for dgemm

/// Columns first to last of a dense matrix without a copy, as long as it lives; one at a time.
class ColumnRange {
 public:
  ColumnRange(Mat dense, PetscInt first, PetscInt last) : dense_(dense)
  {
    petsc::check(MatDenseGetSubMatrix(dense, PETSC_DECIDE, PETSC_DECIDE, first, last, &columns_));
  }
  ~ColumnRange() { MatDenseRestoreSubMatrix(dense_, &columns_); }
  ColumnRange(const ColumnRange&) = delete;
  ColumnRange& operator=(const ColumnRange&) = delete;
  operator Mat() const { return columns_; }  // NOLINT(google-explicit-constructor): as PETSc's

 private:
  Mat dense_;
  Mat columns_ = nullptr;
};

/// From above in the columns of `to` from first_column on.
void copy_columns(SmallMatrix& to, PetscInt first_column, const SmallMatrix& from)
{
  for (PetscInt j = 0; j < from.n_cols; ++j) {
    for (PetscInt i = 0; i < from.n_rows; ++i) to(i, first_column + j) = from(i, j);
  }
}

void mirror_upper_triangle(SmallMatrix& A)
{
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < j; ++i) A(j, i) = A(i, j);
  }
}

/// X^T M_ss Psi, block by block, for X = Psi and X = Phi.
struct MassProducts {
  SmallMatrix Psi_M_Psi;  ///< [n_m x n_m]
  SmallMatrix Phi_M_Psi;  ///< [n_CB x n_m]
};

MassProducts mass_products(const CraigBamptonBasis& Q_CB, Mat M_ss)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(Q_CB.Psi, nullptr, &n_m));
  MassProducts products{.Psi_M_Psi = {n_m, n_m}, .Phi_M_Psi = {Q_CB.n_modes(), n_m}};
  const SparseProduct product(M_ss);
  for (PetscInt first = 0; first < n_m; first += block_columns) {
    const PetscInt last = std::min(first + block_columns, n_m);
    const petsc::Matrix M_Psi = uninitialized_dense(M_ss, last - first);
    product.apply(ColumnRange(Q_CB.Psi, first, last), M_Psi);
    // The upper triangle of Psi^T M Psi is enough.
    copy_columns(products.Psi_M_Psi, first, inner_product(ColumnRange(Q_CB.Psi, 0, last), M_Psi));
    if (Q_CB.modes) {
      copy_columns(products.Phi_M_Psi, first, inner_product(Q_CB.modes->Phi, M_Psi));
    }
  }
  mirror_upper_triangle(products.Psi_M_Psi);
  return products;
}

/// K_G = K_mm + K_ms Psi, symmetric to the last bit.
SmallMatrix guyan_stiffness(const CraigBamptonBasis& Q_CB, const Blocks& K)
{
  SmallMatrix K_G = replicate(K.mm);
  const SmallMatrix Psi_K_sm = inner_product_sparse(Q_CB.Psi, K.sm);
  for (PetscInt j = 0; j < K_G.n_cols; ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      const double mean = 0.5 * (K_G(i, j) + K_G(j, i) + Psi_K_sm(i, j) + Psi_K_sm(j, i));
      K_G(i, j) = K_G(j, i) = mean;
    }
  }
  return K_G;
}

SmallMatrix guyan_mass(const MassProducts& products, const CraigBamptonBasis& Q_CB, const Blocks& M)
{
  SmallMatrix M_G = replicate(M.mm);
  const SmallMatrix Psi_M_sm = inner_product_sparse(Q_CB.Psi, M.sm);
  for (PetscInt j = 0; j < M_G.n_cols; ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      const double Psi_M_Psi = 0.5 * (products.Psi_M_Psi(i, j) + products.Psi_M_Psi(j, i));
      const double M_mm = 0.5 * (M_G(i, j) + M_G(j, i));
      M_G(i, j) = M_G(j, i) = M_mm + Psi_M_sm(i, j) + Psi_M_sm(j, i) + Psi_M_Psi;
    }
  }
  return M_G;
}

void set_leading_block(SmallMatrix& A, const SmallMatrix& block)
{
  for (PetscInt j = 0; j < block.n_cols; ++j) {
    for (PetscInt i = 0; i < block.n_rows; ++i) A(i, j) = block(i, j);
  }
}

}  // namespace

ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M)
{
  const MassProducts products = mass_products(Q_CB, M.ss);
  const PetscInt n_m = products.Psi_M_Psi.n_rows;
  const PetscInt n_q = Q_CB.n_modes();
  ReducedModel reduced{
      .K = {n_m + n_q, n_m + n_q}, .M = {n_m + n_q, n_m + n_q}, .n_masters = n_m, .omega = {}};
  set_leading_block(reduced.K, guyan_stiffness(Q_CB, K));
  set_leading_block(reduced.M, guyan_mass(products, Q_CB, M));
  if (!Q_CB.modes) return reduced;
  reduced.omega = Q_CB.modes->omega;
  const SmallMatrix Phi_M_sm = inner_product_sparse(Q_CB.modes->Phi, M.sm);
  for (PetscInt k = 0; k < n_q; ++k) {
    reduced.K(n_m + k, n_m + k) = reduced.omega[k] * reduced.omega[k];
    reduced.M(n_m + k, n_m + k) = 1.0;
    for (PetscInt j = 0; j < n_m; ++j) {
      const double P_kj = products.Phi_M_Psi(k, j) + Phi_M_sm(k, j);
      reduced.M(n_m + k, j) = reduced.M(j, n_m + k) = P_kj;
    }
  }
  return reduced;
}

}  // namespace chladni::reduce
