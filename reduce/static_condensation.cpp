#include "reduce/static_condensation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/storage.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// All energies here are shares of the rows' own: scaled by the diagonal of K, whose rows are far
// above the round-off of K_G where K_G itself is nothing else.

/// K_mm + K_ms Psi, symmetric to the last bit.
MatrixXd condensed(MatrixXd K_mm, Mat Psi, const Blocks& K)
{
  const MatrixXd Psi_K_sm = linear::inner_product_sparse(Psi, K.sm);
  for (PetscInt j = 0; j < K_mm.cols(); ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      const double mean = 0.5 * (K_mm(i, j) + K_mm(j, i) + Psi_K_sm(i, j) + Psi_K_sm(j, i));
      K_mm(i, j) = K_mm(j, i) = mean;
    }
  }
  return K_mm;
}

/// sqrt(K_ii), of the largest one for rows without a diagonal.
std::vector<double> row_scales(const MatrixXd& K_mm)
{
  double largest = 0.0;
  for (PetscInt i = 0; i < K_mm.rows(); ++i) largest = std::max(largest, K_mm(i, i));
  if (largest == 0.0) largest = 1.0;
  std::vector<double> scales;
  for (PetscInt i = 0; i < K_mm.rows(); ++i)
    scales.push_back(std::sqrt(K_mm(i, i) > 0.0 ? K_mm(i, i) : largest));
  return scales;
}

/// Eigenpairs of K_G scaled, those of the first rank on all ranks.
linear::SymmetricEigen energies_of(MatrixXd K_G, const std::vector<double>& scales, MPI_Comm comm)
{
  for (PetscInt j = 0; j < K_G.cols(); ++j)
    for (PetscInt i = 0; i < K_G.rows(); ++i) K_G(i, j) /= scales[i] * scales[j];
  linear::SymmetricEigen eigen{.values = std::vector<double>(K_G.rows()), .vectors = K_G};
  if (petsc::rank(comm) == 0) eigen = linear::symmetric_eigen(std::move(K_G));
  linear::broadcast_numbers(eigen.values, comm);
  linear::broadcast_numbers(linear::values_of(eigen.vectors), comm);
  return eigen;
}

/// How many of the softest motions may be round-off: a rotation about a single node has the energy
/// of all rows of the body, of which its own may be a millionth of a millionth.
PetscInt n_candidates(const std::vector<double>& energies)
{
  constexpr double soft = 1e-6;
  constexpr PetscInt always = 12;
  const auto n_soft = std::ranges::upper_bound(energies, soft) - energies.begin();
  return std::min(static_cast<PetscInt>(energies.size()),
                  std::max(static_cast<PetscInt>(n_soft), always));
}

/// u^T diag(K) u of the first k eigenvectors, u = [u_m; Psi u_m].
MatrixXd energies_of_rows(const linear::SymmetricEigen& eigen, const std::vector<double>& scales,
                          PetscInt k, Mat Psi, Mat K_ss)
{
  MatrixXd Z = MatrixXd::Zero(eigen.vectors.rows(), k);
  for (PetscInt j = 0; j < k; ++j)
    for (PetscInt i = 0; i < Z.rows(); ++i) Z(i, j) = eigen.vectors(i, j) / scales[i];
  const petsc::Matrix U = linear::uninitialized_dense(Psi, k);
  petsc::check(MatZeroEntries(U));
  linear::add_product(1.0, Psi, Z, U);
  const petsc::Vector d = linear::diagonal(K_ss);
  petsc::check(VecSqrtAbs(d));
  petsc::check(MatDiagonalScale(U, d, nullptr));
  MatrixXd N = linear::inner_product(U, U);
  for (PetscInt j = 0; j < k; ++j) N(j, j) += 1.0;  // of the masters
  return N;
}

/// S N^(-1/2) with the eigenvectors S of N, which is at least I.
MatrixXd inverse_root(const MatrixXd& N)
{
  linear::SymmetricEigen eigen = linear::symmetric_eigen(N);
  for (PetscInt j = 0; j < N.cols(); ++j)
    for (PetscInt i = 0; i < N.rows(); ++i) eigen.vectors(i, j) /= std::sqrt(eigen.values[j]);
  return eigen.vectors;
}

/// Columns made orthonormal one after the other.
void orthonormalize(MatrixXd& Y)
{
  for (PetscInt j = 0; j < Y.cols(); ++j) {
    double* column = &Y(0, j);
    for (PetscInt pass = 0; pass < 2; ++pass) {
      for (PetscInt k = 0; k < j; ++k) {
        double dot = 0.0;
        for (PetscInt i = 0; i < Y.rows(); ++i) dot += Y(i, k) * column[i];
        for (PetscInt i = 0; i < Y.rows(); ++i) column[i] -= dot * Y(i, k);
      }
      double norm = 0.0;
      for (PetscInt i = 0; i < Y.rows(); ++i) norm += column[i] * column[i];
      for (PetscInt i = 0; i < Y.rows(); ++i) column[i] /= std::sqrt(norm);
    }
  }
}

/// Combinations of the first eigenvectors, first those that K does not resist, all orthonormal.
struct Combinations {
  MatrixXd Y;
  PetscInt n_unresisted;
  PetscInt n_soft;  ///< with the others whose energy is hardly more
  double least;     ///< energy over that of the rows
};

/// Of the energy of the rows, what a motion that K does not resist may have. It was 2 eps at most
/// on solids and plates from 300 to 15000 DOFs, 45 eps on 44,000 small matrices without zeros,
/// whose least true energy was a million eps.
constexpr double round_off_of_energy = 128.0 * eps;

Combinations combinations(const std::vector<double>& energies, const MatrixXd& N)
{
  const MatrixXd S = inverse_root(N);
  MatrixXd C = MatrixXd::Zero(N.rows(), N.rows());
  for (PetscInt j = 0; j < C.cols(); ++j) {
    for (PetscInt i = 0; i < C.rows(); ++i)
      for (PetscInt k = 0; k < C.rows(); ++k) C(i, j) += S(k, i) * energies[k] * S(k, j);
  }
  const linear::SymmetricEigen share = linear::symmetric_eigen(std::move(C));
  Combinations found{.Y = linear::product(S, share.vectors),
                     .n_unresisted = 0,
                     .n_soft = 0,
                     .least = share.values.front()};
  orthonormalize(found.Y);
  constexpr double soft = 1e-6;
  const auto n_below = [&](double energy) {
    return static_cast<PetscInt>(std::ranges::upper_bound(share.values, energy) -
                                 share.values.begin());
  };
  // Negative energies tell how exact K is, in files with few digits less than the machine.
  found.n_unresisted = n_below(std::max(round_off_of_energy, -4.0 * found.least));
  found.n_soft = std::max(found.n_unresisted, n_below(soft));
  return found;
}

/// Those of the first rank on all ranks, that none decides otherwise.
Combinations combinations_everywhere(const std::vector<double>& energies, const MatrixXd& N,
                                     MPI_Comm comm)
{
  Combinations found{.Y = N, .n_unresisted = 0, .n_soft = 0, .least = 0.0};
  if (petsc::rank(comm) == 0) found = combinations(energies, N);
  linear::broadcast_numbers(linear::values_of(found.Y), comm);
  MPI_Bcast(&found.n_unresisted, 1, MPIU_INT, 0, comm);
  MPI_Bcast(&found.n_soft, 1, MPIU_INT, 0, comm);
  MPI_Bcast(&found.least, 1, MPI_DOUBLE, 0, comm);
  return found;
}

/// The set of each coordinate, of those that K_G does not couple.
std::vector<int> sets_of_coordinates(const MatrixXd& K_G)
{
  std::vector<int> set_of(std::size_t(K_G.rows()), 0);
  int number = 0;
  for (const std::vector<Eigen::Index>& set : linear::decoupled_coordinates(K_G, K_G)) {
    for (const Eigen::Index i : set) set_of[std::size_t(i)] = number;
    ++number;
  }
  return set_of;
}

/// (I - U U^T) A (I - U U^T) of the scaled A = K_G and orthonormal U, symmetric to the last bit and
/// without scales; rows that hold round-off alone are zero, and so is what does not couple in K_G:
/// motions of several sets are sums of motions of each.
MatrixXd without_motions(const MatrixXd& K_G, const MatrixXd& U, const std::vector<double>& scales)
{
  constexpr double round_off = 64.0 * eps;
  const Eigen::Index n = U.rows(), r = U.cols();
  MatrixXd AU = MatrixXd::Zero(n, r), half = MatrixXd::Zero(r, r);  // half of U^T A U
  const auto scaled = [&](Eigen::Index i, Eigen::Index j) {
    return K_G(i, j) / (scales[i] * scales[j]);
  };
  for (PetscInt k = 0; k < r; ++k) {
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < n; ++i) AU(i, k) += scaled(i, j) * U(j, k);
    for (PetscInt l = 0; l < r; ++l)
      for (PetscInt i = 0; i < n; ++i) half(l, k) += 0.5 * U(i, l) * AU(i, k);
  }
  const MatrixXd share = linear::product(U, half);
  MatrixXd K = MatrixXd::Zero(n, n);
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      double value = scaled(i, j);
      for (PetscInt k = 0; k < r; ++k)
        value -= (AU(i, k) - share(i, k)) * U(j, k) + U(i, k) * (AU(j, k) - share(j, k));
      K(i, j) = value;
    }
  }
  const auto is_zero = [&](Eigen::Index i) { return r == n || K(i, i) < round_off; };
  const std::vector<int> set_of = sets_of_coordinates(K_G);
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = 0; i <= j; ++i) {
      const bool vanishes = is_zero(i) || is_zero(j) || set_of[i] != set_of[j];
      if (i != j) K(i, j) = K(j, i) = vanishes ? 0.0 : scales[i] * K(i, j) * scales[j];
    }
  }
  for (PetscInt i = 0; i < n; ++i) K(i, i) = is_zero(i) ? 0.0 : scales[i] * K(i, i) * scales[i];
  return K;
}

/// What the reduction cannot do with.
[[noreturn]] void refuse_indefinite(double least)
{
  throw Error(
      fmt::format("reduction: K is indefinite: a motion of the masters has an energy of "
                  "{:.1e} of that of its rows; K must be positive semidefinite",
                  least));
}

/// u^T M u of the motions u = [R; Psi R]. Through u itself, not through M_G: the slaves that stand
/// still have round-off in u, which is squared here, but not in the sums of large entries of M_G.
MatrixXd mass_of(const MatrixXd& R, Mat Psi, const Blocks& M)
{
  const petsc::Matrix U = linear::uninitialized_dense(Psi, R.cols());
  const petsc::Matrix MU = linear::uninitialized_dense(Psi, R.cols());
  petsc::check(MatZeroEntries(U));
  linear::add_product(1.0, Psi, R, U);
  linear::SparseProduct(M.ss).apply(U, MU);
  const MatrixXd sm = linear::product(linear::inner_product_sparse(U, M.sm), R);
  const MatrixXd mm = linear::product(R.transpose(), linear::product(linear::replicate(M.mm), R));
  return linear::inner_product(U, MU) + sm + sm.transpose() + mm;
}

/// The largest M_ii / K_ii, s^2: of the slow rows. PETSc takes 1 / 0 for 0.
double slowest_row(const Blocks& K, const Blocks& M)
{
  double largest = 0.0;
  for (const auto& [K_part, M_part] :
       {std::pair{Mat(K.ss), Mat(M.ss)}, std::pair{Mat(K.mm), Mat(M.mm)}}) {
    const petsc::Vector ratio = linear::diagonal(M_part);
    PetscReal of_part = 0.0;
    petsc::check(VecPointwiseDivide(ratio, ratio, linear::diagonal(K_part)));
    petsc::check(VecMax(ratio, nullptr, &of_part));
    largest = std::max(largest, of_part);
  }
  return largest;
}

/// Whether some motion R is without mass but for round-off. Each has the energy 1 in the diagonal
/// of K_mm, so that its mass is an M / K of its own, which those of the rows are compared with: K_r
/// may hold nothing at all.
bool is_massless(const MatrixXd& mass, double slowest)
{
  constexpr double none = 1e-20, dependent = 1e-14;
  const Eigen::VectorXd own = mass.diagonal();
  if (!(own.minCoeff() > none * slowest)) return true;
  const Eigen::VectorXd unit = own.cwiseSqrt().cwiseInverse();
  const linear::SymmetricEigen shares =
      linear::symmetric_eigen(MatrixXd(unit.asDiagonal() * mass * unit.asDiagonal()));
  return !(shares.values.front() > dependent);
}

/// Of soft motions Y those that neither K nor M resists but for round-off. What K alone does not
/// resist may be mixed with motions that it resists by little, whose mass would hide that of the
/// mixture.
/// @param E  Y^T K Y
/// @param N  Y^T diag(K) Y
MatrixXd unresisted_by_both(const MatrixXd& E, const MatrixXd& mass, double slowest,
                            const MatrixXd& N)
{
  const MatrixXd S = inverse_root(N);
  const linear::SymmetricEigen share = linear::symmetric_eigen(
      linear::product(S.transpose(), linear::product(E + mass / slowest, S)));
  const auto n = std::ranges::upper_bound(share.values, round_off_of_energy) - share.values.begin();
  return linear::product(S, share.vectors.leftCols(n));
}

/// Where every rank says so or none.
/// @param of           the soft motions, in coordinates of the first eigenvectors of K_G
/// @param N, energies  Gram matrix of the rows' energies and energies of these eigenvectors
/// @param T            the soft motions at the masters; those without energy come first
void refuse_massless(const Combinations& of, const MatrixXd& N, const std::vector<double>& energies,
                     const MatrixXd& T, Mat Psi, const Blocks& K, const Blocks& M)
{
  const MPI_Comm comm = petsc::communicator(Psi);
  const double slowest = slowest_row(K, M);
  const MatrixXd mass = mass_of(T, Psi, M);
  bool is_none = is_massless(mass.topLeftCorner(of.n_unresisted, of.n_unresisted), slowest);
  if (slowest > 0.0 && T.cols() > of.n_unresisted) {
    const MatrixXd Y = of.Y.leftCols(of.n_soft);
    const MatrixXd E =
        Y.transpose() * Eigen::VectorXd::Map(energies.data(), Y.rows()).asDiagonal() * Y;
    MatrixXd V = unresisted_by_both(E, mass, slowest, Y.transpose() * N * Y);
    auto n = static_cast<PetscInt>(V.cols());
    MPI_Bcast(&n, 1, MPIU_INT, 0, comm);
    V.conservativeResize(T.cols(), n);
    linear::broadcast_numbers(linear::values_of(V), comm);
    if (n > 0) is_none = is_massless(mass_of(linear::product(T, V), Psi, M), slowest) || is_none;
  }
  if (linear::value_of_first_rank(is_none ? 1.0 : 0.0, comm) == 0.0) return;
  throw Error(
      "a motion has neither stiffness nor mass, so the pencil (K, M) is singular; give its DOFs "
      "stiffness or mass, or leave them out");
}

}  // namespace

GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K, const Blocks& M)
{
  constexpr double indefinite = -1e-8;
  const MPI_Comm comm = petsc::communicator(Psi);
  const MatrixXd K_mm = linear::replicate(K.mm);
  const std::vector<double> scales = row_scales(K_mm);
  GuyanStiffness guyan{.K = condensed(K_mm, Psi, K), .R = MatrixXd(K_mm.rows(), 0)};
  if (K_mm.size() == 0) return guyan;
  const linear::SymmetricEigen eigen = energies_of(guyan.K, scales, comm);
  const PetscInt k = n_candidates(eigen.values);
  const MatrixXd N = energies_of_rows(eigen, scales, k, Psi, K.ss);
  const Combinations found = combinations_everywhere(eigen.values, N, comm);
  if (found.least < indefinite) refuse_indefinite(found.least);
  if (found.n_unresisted == 0) return guyan;
  MatrixXd T =
      linear::product(eigen.vectors.leftCols(found.Y.rows()), found.Y.leftCols(found.n_soft));
  guyan.K = without_motions(guyan.K, T.leftCols(found.n_unresisted), scales);
  linear::broadcast_numbers(linear::values_of(guyan.K), comm);
  for (PetscInt j = 0; j < T.cols(); ++j)
    for (PetscInt i = 0; i < T.rows(); ++i) T(i, j) /= scales[i];
  guyan.R = T.leftCols(found.n_unresisted);
  refuse_massless(found, N, eigen.values, T, Psi, K, M);
  return guyan;
}

namespace {

constexpr PetscInt block_columns = 64;  // right-hand sides at a time: bounds the memory

/// Columns first to last of the sparse A, copied into the zeroed dense B.
void copy_columns(Mat A, PetscInt first, PetscInt last, Mat B)
{
  petsc::check(MatZeroEntries(B));
  linear::for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    if (column < first || column >= last) return;
    petsc::check(MatSetValue(B, row, column - first, value, INSERT_VALUES));
  });
  petsc::check(MatAssemblyBegin(B, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(B, MAT_FINAL_ASSEMBLY));
}

/// -K_ss^-1 K_sm block by block. PETSc 3.18 fails with sparse right-hand sides on several ranks
/// where a rank has none (MUMPS error -27), and its dense ones are gathered: blocks keep that
/// small.
void solve_by_blocks(Mat factor, Mat K_sm, Mat Psi)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(Psi, nullptr, &n_m));
  for (PetscInt first = 0; first < n_m; first += block_columns) {
    const PetscInt last = std::min(first + block_columns, n_m);
    Mat X = nullptr;
    petsc::Matrix B;
    petsc::check(MatDenseGetSubMatrix(Psi, PETSC_DECIDE, PETSC_DECIDE, first, last, &X));
    petsc::check(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, B.put()));
    copy_columns(K_sm, first, last, B);
    petsc::check(MatScale(B, -1.0));  // not Psi at once: its numbers may be more than PETSc counts
    petsc::check(MatMatSolve(factor, B, X));
    petsc::check(MatDenseRestoreSubMatrix(Psi, &X));
  }
}

}  // namespace

petsc::Matrix constraint_modes(const linear::Factorization& K_ss, const Blocks& K)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(K.ms, &n_m, nullptr));
  petsc::Matrix Psi = linear::large_dense(K.ss, n_m, K_ss.options().scratch);
  if (petsc::size(petsc::communicator(K.ms)) == 1 || linear::is_ours(K_ss.factor())) {
    petsc::Matrix minus_K_ms;
    petsc::check(MatDuplicate(K.ms, MAT_COPY_VALUES, minus_K_ms.put()));
    petsc::check(MatScale(minus_K_ms, -1.0));
    petsc::check(MatMatTransposeSolve(K_ss.factor(), minus_K_ms, Psi));
  } else {
    solve_by_blocks(K_ss.factor(), K.sm, Psi);
  }
  return Psi;
}

namespace {

/// S A^(-1/2) with the eigenvectors S of a semidefinite A in units of its diagonal, as far as A is
/// regular.
MatrixXd inverse_root(MatrixXd A, MPI_Comm comm)
{
  constexpr double singular = 1e-12;
  std::vector<double> unit;
  for (PetscInt i = 0; i < A.rows(); ++i)
    unit.push_back(A(i, i) > 0.0 ? 1.0 / std::sqrt(A(i, i)) : 0.0);
  for (PetscInt j = 0; j < A.cols(); ++j)
    for (PetscInt i = 0; i < A.rows(); ++i) A(i, j) *= unit[i] * unit[j];
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(std::move(A), comm);
  const auto n = static_cast<PetscInt>(eigen.values.size());
  const auto first = static_cast<PetscInt>(std::ranges::upper_bound(eigen.values, singular) -
                                           eigen.values.begin());
  MatrixXd root = MatrixXd::Zero(n, n - first);
  for (PetscInt j = first; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i)
      root(i, j - first) = unit[i] * eigen.vectors(i, j) / std::sqrt(eigen.values[j]);
  return root;
}

/// X^T X after its rows are scaled by the power p of the diagonal of K_ss.
MatrixXd scaled_gram(petsc::Matrix X, Mat K_ss, double p)
{
  const petsc::Vector d = linear::diagonal(K_ss);
  petsc::check(VecPow(d, p));
  petsc::check(MatDiagonalScale(X, d, nullptr));
  return linear::inner_product(X, X);
}

/// Combinations Y of the motions with K_sm R_m + K_ss R_s = 0 to round-off, in units of the
/// diagonal.
MatrixXd unresisted(const MatrixXd& R_m, Mat R_s, const Blocks& K)
{
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  const MPI_Comm comm = petsc::communicator(K.ss);
  petsc::Matrix force = linear::uninitialized_dense(K.ss, R_m.cols()), copy;
  linear::SparseProduct(K.ss).apply(R_s, force);
  linear::add_sparse_product(K.sm, R_m, force);
  petsc::check(MatDuplicate(R_s, MAT_COPY_VALUES, copy.put()));
  const MatrixXd S = inverse_root(scaled_gram(std::move(copy), K.ss, 0.5), comm);
  const MatrixXd F = scaled_gram(std::move(force), K.ss, -0.5);
  const linear::SymmetricEigen share =
      linear::symmetric_eigen(linear::product(S.transpose(), linear::product(F, S)), comm);
  const auto n =
      std::ranges::upper_bound(share.values, round_off * round_off) - share.values.begin();
  return linear::product(S, share.vectors.leftCols(n));
}

/// (R^T W R)^-1 R^T W with the diagonal W of K_mm, on the masters' share of the motions.
MatrixXd weighted_inverse(const MatrixXd& R_m, const MatrixXd& K_mm, MPI_Comm comm)
{
  MatrixXd WR = R_m;
  for (PetscInt j = 0; j < WR.cols(); ++j)
    for (PetscInt i = 0; i < WR.rows(); ++i) WR(i, j) *= std::max(K_mm(i, i), 0.0);
  const MatrixXd root = inverse_root(linear::product(R_m.transpose(), WR), comm);
  return linear::product(linear::product(root, root.transpose()), WR.transpose());
}

/// Some slaves of this rank, counted from its first, and the masters that K couples to any of them.
struct CoupledRows {
  std::vector<PetscInt> slaves;
  std::vector<PetscInt> masters;  ///< the same on every rank
};

/// Number of the set that each slave of this rank is in.
std::vector<int> set_of_rows(const std::vector<petsc::IndexSet>& sets, Mat K_ss)
{
  PetscInt n = 0;
  petsc::check(MatGetLocalSize(K_ss, &n, nullptr));
  std::vector<int> set_of_row(std::size_t(n), 0);
  for (std::size_t k = 0; k < sets.size(); ++k)
    for (const PetscInt i : petsc::own_rows(sets[k], K_ss)) set_of_row[i] = static_cast<int>(k);
  return set_of_row;
}

/// All slaves in sets that K_ss does not couple: constraint modes are zero in the sets that their
/// master has no share of.
std::vector<CoupledRows> coupled_rows(const Blocks& K)
{
  const std::vector<petsc::IndexSet> sets = linear::decoupled_rows(K.ss, K.ss);
  const std::size_t n_sets = std::max<std::size_t>(sets.size(), 1);
  const std::vector<int> set_of_row = set_of_rows(sets, K.ss);
  PetscInt begin = 0, n_m = 0;
  petsc::check(MatGetOwnershipRange(K.sm, &begin, nullptr));
  petsc::check(MatGetSize(K.sm, nullptr, &n_m));
  std::vector<int> is_coupled(n_sets * n_m, sets.empty() ? 1 : 0);
  linear::for_local_entries(K.sm, [&](PetscInt row, PetscInt column, double value) {
    if (value != 0.0) is_coupled[std::size_t(set_of_row[row - begin]) * n_m + column] = 1;
  });
  MPI_Allreduce(MPI_IN_PLACE, is_coupled.data(), static_cast<int>(is_coupled.size()), MPI_INT,
                MPI_MAX, petsc::communicator(K.sm));
  std::vector<CoupledRows> coupled(n_sets);
  for (std::size_t i = 0; i < set_of_row.size(); ++i)
    coupled[set_of_row[i]].slaves.push_back(static_cast<PetscInt>(i));
  for (std::size_t k = 0; k < n_sets; ++k)
    for (PetscInt j = 0; j < n_m; ++j)
      if (is_coupled[k * n_m + j] != 0) coupled[k].masters.push_back(j);
  return coupled;
}

/// The rows of a dense matrix that are asked for.
MatrixXd chosen_rows(const linear::LocalRows& X, std::span<const PetscInt> rows)
{
  MatrixXd some(std::ssize(rows), X.n_cols());
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      some(static_cast<Eigen::Index>(i), j) = X(rows[i], j);
  return some;
}

/// Psi <- Psi + error W in some rows and columns.
void add_correction(const CoupledRows& rows, Mat error, const MatrixXd& W, Mat Psi)
{
  constexpr std::size_t piece = 1024;  // rows at a time: they and the sums stay in the cache
  const linear::LocalRows errors(error);
  PetscInt ld = 0;
  PetscScalar* psi = nullptr;
  petsc::check(MatDenseGetLDA(Psi, &ld));
  petsc::check(MatDenseGetArray(Psi, &psi));
  for (std::size_t first = 0; first < rows.slaves.size(); first += piece) {
    const auto some =
        std::span(rows.slaves).subspan(first).first(std::min(piece, rows.slaves.size() - first));
    const MatrixXd correction = linear::product(chosen_rows(errors, some), W);
    for (Eigen::Index j = 0; j < W.cols(); ++j) {
      double* column = psi + std::size_t(rows.masters[j]) * ld;
      for (std::size_t i = 0; i < some.size(); ++i)
        column[some[i]] += correction(static_cast<Eigen::Index>(i), j);
    }
  }
  petsc::check(MatDenseRestoreArray(Psi, &psi));
}

}  // namespace

petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions)
{
  const MatrixXd all_m = master_rows(motions.R, motions.dofs);
  const petsc::Matrix all_s = slave_rows(motions.R, motions.dofs, motions.K.ss);
  const MatrixXd Y = unresisted(all_m, all_s, motions.K);
  if (Y.cols() == 0) return Psi;
  const MatrixXd R_m = linear::product(all_m, Y), K_mm = linear::replicate(motions.K.mm);
  const petsc::Matrix error = linear::uninitialized_dense(Psi, Y.cols());  // R_s - Psi R_m
  petsc::check(MatZeroEntries(error));
  linear::add_product(1.0, all_s, Y, error);
  linear::add_product(-1.0, Psi, R_m, error);
  for (const CoupledRows& rows : coupled_rows(motions.K)) {
    const std::vector<PetscInt>& m = rows.masters;
    if (m.empty()) continue;
    const MatrixXd W =
        weighted_inverse(R_m(m, every), K_mm(m, m), petsc::communicator(motions.K.ss));
    add_correction(rows, error, W, Psi);
  }
  return Psi;
}

}  // namespace chladni::reduce
