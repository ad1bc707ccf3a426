#include "reduce/guyan_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/dense/decoupled_coordinates.hpp"
#include "linear/kernels/diagonal.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/symmetric_eigen.hpp"

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
  double least;  ///< energy over that of the rows
};

Combinations combinations(const std::vector<double>& energies, const MatrixXd& N)
{
  const MatrixXd S = inverse_root(N);
  MatrixXd C = MatrixXd::Zero(N.rows(), N.rows());
  for (PetscInt j = 0; j < C.cols(); ++j) {
    for (PetscInt i = 0; i < C.rows(); ++i)
      for (PetscInt k = 0; k < C.rows(); ++k) C(i, j) += S(k, i) * energies[k] * S(k, j);
  }
  const linear::SymmetricEigen share = linear::symmetric_eigen(std::move(C));
  Combinations found{
      .Y = linear::product(S, share.vectors), .n_unresisted = 0, .least = share.values.front()};
  orthonormalize(found.Y);
  // Twice eps at most on solids and plates from 300 to 15000 DOFs. Negative energies tell how exact
  // K is, in files with few digits less than the machine.
  const double round_off = std::max(10.0 * eps, -4.0 * found.least);
  found.n_unresisted = static_cast<PetscInt>(std::ranges::upper_bound(share.values, round_off) -
                                             share.values.begin());
  return found;
}

/// Those of the first rank on all ranks, that none decides otherwise.
Combinations combinations_everywhere(const std::vector<double>& energies, const MatrixXd& N,
                                     MPI_Comm comm)
{
  Combinations found{.Y = N, .n_unresisted = 0, .least = 0.0};
  if (petsc::rank(comm) == 0) found = combinations(energies, N);
  linear::broadcast_numbers(linear::values_of(found.Y), comm);
  MPI_Bcast(&found.n_unresisted, 1, MPIU_INT, 0, comm);
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

}  // namespace

GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K)
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
  const MatrixXd U =
      linear::product(eigen.vectors.leftCols(found.Y.rows()), found.Y.leftCols(found.n_unresisted));
  guyan.K = without_motions(guyan.K, U, scales);
  linear::broadcast_numbers(linear::values_of(guyan.K), comm);
  guyan.R = U;
  for (PetscInt j = 0; j < U.cols(); ++j)
    for (PetscInt i = 0; i < U.rows(); ++i) guyan.R(i, j) /= scales[i];
  return guyan;
}

}  // namespace chladni::reduce
