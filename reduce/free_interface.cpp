#include "reduce/free_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reduce/block_lanczos.hpp"
#include "reduce/block_rows.hpp"
#include "reduce/free_flexibility.hpp"
#include "reduce/guyan.hpp"
#include "reduce/sparse_product.hpp"
#include "reduce/symmetric_eigen.hpp"

namespace chladni::reduce {

namespace {

/// Of the modes: their rows stand in the reduced matrices, so that no run may differ from another
/// by more than round-off.
constexpr double tolerance = 1e-11;

/// A with unit diagonal, so that units do not decide.
SmallMatrix scaled_to_unit_diagonal(const SmallMatrix& A)
{
  SmallMatrix scaled = A;
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) {
      const double product = A(i, i) * A(j, j);
      scaled(i, j) = product > 0.0 ? A(i, j) / std::sqrt(product) : 0.0;
    }
  }
  return scaled;
}

/// The first n modes and those partners of the last one that follow.
PetscInt complete_cluster(const std::vector<double>& lambda, PetscInt n)
{
  constexpr double pair_gap = 2e-4;
  while (n > 0 && n < std::ssize(lambda) && lambda[n] - lambda[n - 1] < pair_gap * lambda[n]) ++n;
  return n;
}

/// The lowest elastic modes, as many or as far up as wanted; vectors of some more.
EigenPairs elastic_pairs(const WholeSystem& body, const FreeFlexibility& flexibility,
                         const ReduceOptions& wanted)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(body.K, &n, nullptr));
  n -= LocalRows(flexibility.R()).n_cols();
  const auto lowest = [&](PetscInt n_pairs) {
    return block_lanczos(flexibility.factor(), body.M,
                         {.n_pairs = n_pairs, .tolerance = tolerance});
  };
  if (wanted.modes) {
    EigenPairs pairs = lowest(std::min<PetscInt>(*wanted.modes + 2, n));  // to see partners
    if (std::ssize(pairs.lambda) < *wanted.modes) {
      throw Error(
          fmt::format("free_interface_modes: {} of {} elastic modes found; there are no more",
                      pairs.lambda.size(), *wanted.modes));
    }
    pairs.lambda.resize(complete_cluster(pairs.lambda, *wanted.modes));
    return pairs;
  }
  if (!wanted.cutoff_Hz) {
    throw Error(
        "free_interface_modes: a tolerance needs Craig-Bampton; give the number of modes or "
        "cutoff_Hz");
  }
  const double lambda_max = std::pow(2.0 * std::numbers::pi * *wanted.cutoff_Hz, 2);
  for (PetscInt n_asked = std::min<PetscInt>(32, n);; n_asked = std::min(2 * n_asked, n)) {
    EigenPairs pairs = lowest(n_asked);
    const auto below = std::ranges::lower_bound(pairs.lambda, lambda_max) - pairs.lambda.begin();
    if (below == std::ssize(pairs.lambda) && n_asked < n) continue;
    pairs.lambda.resize(complete_cluster(pairs.lambda, static_cast<PetscInt>(below)));
    return pairs;
  }
}

/// [R, X] of the first k columns of X.
petsc::Matrix beside(Mat R, Mat X, PetscInt k)
{
  const PetscInt r = LocalRows(R).n_cols();
  petsc::Matrix both = uninitialized_dense(R, r + k);
  if (r > 0) {
    petsc::check(MatCopy(R, ColumnRange(both, 0, r), SAME_NONZERO_PATTERN));
  }
  if (k > 0) {
    petsc::check(MatCopy(ColumnRange(X, 0, k), ColumnRange(both, r, r + k), SAME_NONZERO_PATTERN));
  }
  return both;
}

/// T^T A T
SmallMatrix gram(Mat T, Mat A)
{
  const petsc::Matrix AT = uninitialized_dense(A, LocalRows(T).n_cols());
  SparseProduct(A).apply(T, AT);
  return inner_product(T, AT);
}

SmallMatrix product(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C(A.n_rows, B.n_cols);
  for (PetscInt j = 0; j < B.n_cols; ++j) {
    for (PetscInt k = 0; k < A.n_cols; ++k) {
      for (PetscInt i = 0; i < A.n_rows; ++i) C(i, j) += A(i, k) * B(k, j);
    }
  }
  return C;
}

SmallMatrix transposed(const SmallMatrix& A)
{
  SmallMatrix B(A.n_cols, A.n_rows);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) B(j, i) = A(i, j);
  }
  return B;
}

/// S with S^T G S = I over the directions that are independent to working precision.
SmallMatrix orthonormalizing(const SmallMatrix& G, MPI_Comm comm)
{
  const SymmetricEigen eigen = symmetric_eigen(scaled_to_unit_diagonal(G), comm);
  constexpr double dependent = 1e-12;
  PetscInt r = 0;
  while (r < G.n_rows && eigen.values[G.n_rows - 1 - r] > dependent * eigen.values.back()) ++r;
  SmallMatrix S(G.n_rows, r);
  for (PetscInt k = 0; k < r; ++k) {
    const PetscInt at = G.n_rows - 1 - k;
    for (PetscInt i = 0; i < G.n_rows; ++i) {
      S(i, k) = eigen.vectors(i, at) / std::sqrt(eigen.values[at] * G(i, i));
    }
  }
  return S;
}

/// Ritz vectors of (K_ss, M_ss) among the columns of T, from M x = mu K x, which keeps the lowest
/// accurate.
FixedInterfaceModes ritz_modes(Mat T, const WholeSystem& body)
{
  const MPI_Comm comm = petsc::communicator(T);
  const SmallMatrix S = orthonormalizing(gram(T, body.K_blocks.ss), comm);
  const SymmetricEigen ritz =
      symmetric_eigen(product(transposed(S), product(gram(T, body.M_blocks.ss), S)), comm);
  SmallMatrix V(S.n_cols, S.n_cols);
  FixedInterfaceModes modes;
  for (PetscInt k = 0; k < S.n_cols; ++k) {
    const PetscInt at = S.n_cols - 1 - k;
    if (!(ritz.values[at] > 0.0)) break;  // shapes without mass
    for (PetscInt i = 0; i < S.n_cols; ++i)
      V(i, k) = ritz.vectors(i, at) / std::sqrt(ritz.values[at]);
    modes.omega.push_back(1.0 / std::sqrt(ritz.values[at]));
  }
  V.n_cols = static_cast<PetscInt>(modes.omega.size());
  V.values.resize(std::size_t(V.n_rows) * V.n_cols);
  modes.Phi = uninitialized_dense(body.K_blocks.ss, V.n_cols);
  petsc::check(MatZeroEntries(modes.Phi));
  add_product(1.0, T, product(S, V), modes.Phi);
  return modes;
}

}  // namespace

FreeInterfaceModes free_interface_modes(const WholeSystem& body, Mat Psi,
                                        const ReduceOptions& wanted)
{
  const FreeFlexibility flexibility(body, Psi, guyan_stiffness(Psi, body.K_blocks));
  const EigenPairs elastic = elastic_pairs(body, flexibility, wanted);
  const petsc::Matrix X =
      beside(flexibility.R(), elastic.X, static_cast<PetscInt>(elastic.lambda.size()));
  FreeInterfaceModes free{.X_s = slave_rows(X, body.dofs, body.K_blocks.ss),
                          .X_m = master_rows(X, body.dofs),
                          .omega = {},
                          .n_rigid = LocalRows(flexibility.R()).n_cols()};
  free.omega.resize(free.n_rigid, 0.0);
  for (const double lambda : elastic.lambda) free.omega.push_back(std::sqrt(lambda));
  return free;
}

FixedInterfaceModes rubin_modes(const WholeSystem& body, Mat Psi, const FreeInterfaceModes& free)
{
  petsc::Matrix T;  // X_s - Psi X_m, in the first columns K_ss^-1 (M_ss X_s + M_sm X_m)
  petsc::check(MatDuplicate(free.X_s, MAT_COPY_VALUES, T.put()));
  add_product(-1.0, Psi, free.X_m, T);
  if (free.n_rigid > 0) {
    SmallMatrix R_m(free.X_m.n_rows, free.n_rigid);
    std::copy_n(free.X_m.values.begin(), R_m.values.size(), R_m.values.begin());
    const ColumnRange inertia(T, 0, free.n_rigid);
    const petsc::Matrix R_s = uninitialized_dense(body.K_blocks.ss, free.n_rigid);
    petsc::check(MatCopy(ColumnRange(free.X_s, 0, free.n_rigid), R_s, SAME_NONZERO_PATTERN));
    SparseProduct(body.M_blocks.ss).apply(R_s, inertia);
    add_sparse_product(body.M_blocks.sm, R_m, inertia);
    petsc::check(MatMatSolve(body.K_ss.factor(), inertia, R_s));
    petsc::check(MatCopy(R_s, inertia, SAME_NONZERO_PATTERN));
  }
  return ritz_modes(T, body);
}

SmallMatrix macneal_mass(const CraigBamptonBasis& Q, const Blocks& M,
                         const FreeInterfaceModes& free)
{
  const PetscInt n_m = free.X_m.n_rows, n = n_m + Q.n_modes();
  // Z of the masters: X_s^T (M_ss Psi + M_sm) + X_m^T (M_ms Psi + M_mm)
  const SmallMatrix at_slaves = inertial_coupling(free.X_s, Q.Psi, M);
  SmallMatrix M_mm = replicate(M.mm);
  const SmallMatrix Psi_M_sm = inner_product_sparse(Q.Psi, M.sm);
  for (PetscInt j = 0; j < n_m; ++j) {
    for (PetscInt i = 0; i < n_m; ++i) M_mm(i, j) += Psi_M_sm(j, i);
  }
  const SmallMatrix at_masters = product(transposed(free.X_m), M_mm);
  // and of the modes: (M_ss X_s + M_sm X_m)^T Phi
  petsc::Matrix momentum = uninitialized_dense(M.ss, free.n_modes());
  SparseProduct(M.ss).apply(free.X_s, momentum);
  add_sparse_product(M.sm, free.X_m, momentum);
  const SmallMatrix of_modes = inner_product(momentum, Q.modes->Phi);
  SmallMatrix Z(free.n_modes(), n);
  for (PetscInt k = 0; k < Z.n_rows; ++k) {
    for (PetscInt j = 0; j < n; ++j) {
      Z(k, j) = j < n_m ? at_slaves(k, j) + at_masters(k, j) : of_modes(k, j - n_m);
    }
  }
  return product(transposed(Z), Z);
}

}  // namespace chladni::reduce
