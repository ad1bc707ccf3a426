#include "reduce/free_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reduce/guyan.hpp"
#include "reduce/sparse_product.hpp"
#include "reduce/supported_solutions.hpp"
#include "reduce/symmetric_eigen.hpp"

namespace chladni::reduce {

namespace {

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

/// Rigid-body motions: those that K_G does not resist.
int n_rigid_motions(const SmallMatrix& K_G)
{
  constexpr double zero_energy = 1e-10;
  const std::vector<double> energies = symmetric_eigen(scaled_to_unit_diagonal(K_G)).values;
  return static_cast<int>(std::ranges::count_if(
      energies, [&](double energy) { return energy <= zero_energy * energies.back(); }));
}

/// Rows of a dense X at the slaves.
petsc::Matrix slave_rows(Mat X, const WholeSystem& body)
{
  PetscInt n = 0, first = 0;
  const PetscInt* slaves = nullptr;
  const LocalRows x(X);
  petsc::Matrix X_s = uninitialized_dense(body.K_blocks.ss, x.n_cols());
  PetscScalar* values = nullptr;
  petsc::check(MatGetOwnershipRange(X, &first, nullptr));
  petsc::check(ISGetLocalSize(body.dofs.slaves, &n));
  petsc::check(ISGetIndices(body.dofs.slaves, &slaves));
  petsc::check(MatDenseGetArrayWrite(X_s, &values));
  for (PetscInt j = 0; j < x.n_cols(); ++j) {
    for (PetscInt i = 0; i < n; ++i) values[i + std::size_t(j) * n] = x(slaves[i] - first, j);
  }
  petsc::check(MatDenseRestoreArrayWrite(X_s, &values));
  petsc::check(ISRestoreIndices(body.dofs.slaves, &slaves));
  return X_s;
}

/// Rows of a dense X at the masters, on every rank.
SmallMatrix master_rows(Mat X, IS masters)
{
  const MPI_Comm comm = petsc::communicator(X);
  PetscInt n = 0, n_all = 0, first = 0;
  const PetscInt* indices = nullptr;
  petsc::check(MatGetOwnershipRange(X, &first, nullptr));
  petsc::check(ISGetLocalSize(masters, &n));
  petsc::check(ISGetSize(masters, &n_all));
  PetscInt before = n;
  MPI_Exscan(MPI_IN_PLACE, &before, 1, MPIU_INT, MPI_SUM, comm);
  if (petsc::rank(comm) == 0) before = 0;
  petsc::check(ISGetIndices(masters, &indices));
  SmallMatrix X_m(n_all, LocalRows(X).n_cols());
  {
    const LocalRows x(X);
    for (PetscInt j = 0; j < x.n_cols(); ++j) {
      for (PetscInt i = 0; i < n; ++i) X_m(before + i, j) = x(indices[i] - first, j);
    }
  }
  petsc::check(ISRestoreIndices(masters, &indices));
  sum_over_ranks(X_m, comm);
  return X_m;
}

/// The first n modes and those partners of the last one that follow.
PetscInt complete_cluster(const std::vector<double>& lambda, PetscInt n)
{
  constexpr double pair_gap = 2e-4;
  while (n > 0 && n < std::ssize(lambda) && lambda[n] - lambda[n - 1] < pair_gap * lambda[n]) ++n;
  return n;
}

/// The lowest modes, as many or as far up as wanted.
NaturalModes lowest_modes(const WholeSystem& body, const ReduceOptions& wanted, int n_rigid)
{
  const FreeDofs all = free_dofs(body.K, {});
  PetscInt n = 0;
  petsc::check(MatGetSize(body.K, &n, nullptr));
  if (wanted.modes) {
    const int n_wanted = n_rigid + *wanted.modes;
    const int n_seen = std::min<int>(n_wanted + 2, n);  // to see partners
    NaturalModes modes = natural_modes(body.K, body.M, all,
                                       {.n_modes = std::max(n_seen, n_wanted), .n_rigid = n_rigid});
    modes.lambda.resize(complete_cluster(modes.lambda, n_wanted));
    return modes;
  }
  if (!wanted.cutoff_Hz) {
    throw Error(
        "free_interface_modes: a tolerance needs Craig-Bampton; give the number of modes or "
        "cutoff_Hz");
  }
  const double lambda_max = std::pow(2.0 * std::numbers::pi * *wanted.cutoff_Hz, 2);
  for (int n_asked = n_rigid + 32;; n_asked *= 2) {
    const int n_modes = std::min<int>(n_asked, n);
    NaturalModes modes =
        natural_modes(body.K, body.M, all, {.n_modes = n_modes, .n_rigid = n_rigid});
    const auto below = std::ranges::lower_bound(modes.lambda, lambda_max) - modes.lambda.begin();
    if (below == std::ssize(modes.lambda) && n_modes < n) continue;
    modes.lambda.resize(complete_cluster(modes.lambda, std::max(static_cast<int>(below), n_rigid)));
    return modes;
  }
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
SmallMatrix orthonormalizing(const SmallMatrix& G)
{
  const SymmetricEigen eigen = symmetric_eigen(scaled_to_unit_diagonal(G));
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
  const SmallMatrix S = orthonormalizing(gram(T, body.K_blocks.ss));
  const SymmetricEigen ritz =
      symmetric_eigen(product(transposed(S), product(gram(T, body.M_blocks.ss), S)));
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
  const int n_rigid = n_rigid_motions(guyan_stiffness(Psi, body.K_blocks));
  const NaturalModes all = lowest_modes(body, wanted, n_rigid);
  const auto n = static_cast<PetscInt>(all.lambda.size());
  const ColumnRange X(all.X, 0, n);
  FreeInterfaceModes free{.X_s = slave_rows(X, body),
                          .X_m = master_rows(X, body.dofs.masters),
                          .omega = std::vector<double>(n, 0.0),
                          .n_rigid = n_rigid};
  for (PetscInt i = n_rigid; i < n; ++i) free.omega[i] = std::sqrt(std::max(0.0, all.lambda[i]));
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
