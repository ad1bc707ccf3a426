#include "cyclic/harmonic_modes.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "cyclic/sparse_rows.hpp"
#include "cyclic/symmetric_half.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd;

/// Those in which the modes are solved.
HarmonicCoordinates solved_coordinates(const HarmonicCoordinates& c)
{
  return c.symmetric.size() > 0 ? symmetric_half(c) : c;
}

/// Coordinates that move a held DOF.
std::vector<int> held_coordinates(const HarmonicCoordinates& c, const std::vector<bool>& is_held)
{
  std::vector<bool> moves(std::size_t(c.n()), false);
  for (const SparseRows* T : {&c.X, &c.Y}) {
    for (Index dof = 0; dof < T->rows(); ++dof) {
      if (!is_held[std::size_t(dof)]) continue;
      for (SparseRows::InnerIterator it(*T, dof); it; ++it) moves[std::size_t(it.index())] = true;
    }
  }
  std::vector<int> held;
  for (int i = 0; i < c.n(); ++i)
    if (moves[std::size_t(i)]) held.push_back(i);
  return held;
}

/// The lower triangle without some rows and columns.
Eigen::SparseMatrix<double> lower_without(const SparseRows& A, const std::vector<int>& left_out)
{
  std::vector<int> place(std::size_t(A.rows()), 0);
  for (const int i : left_out) place[std::size_t(i)] = -1;
  int n = 0;
  for (int& i : place)
    if (i == 0) i = n++;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(A.nonZeros()) / 2 + std::size_t(n));
  for (int i = 0; i < A.outerSize(); ++i) {
    if (place[std::size_t(i)] < 0) continue;
    for (SparseRows::InnerIterator a(A, i); a && a.index() <= i; ++a)
      if (const int j = place[std::size_t(a.index())]; j >= 0)
        entries.emplace_back(place[std::size_t(i)], j, a.value());
  }
  Eigen::SparseMatrix<double> lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

MatrixXd first_columns(Mat X, Index n)
{
  PetscInt n_rows = 0, stride = 0;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetSize(X, &n_rows, nullptr));
  petsc::check(MatDenseGetLDA(X, &stride));
  petsc::check(MatDenseGetArrayRead(X, &values));
  MatrixXd columns =
      Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>(values, n_rows, n, {stride});
  petsc::check(MatDenseRestoreArrayRead(X, &values));
  return columns;
}

}  // namespace

HarmonicModes harmonic_modes(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                             const std::vector<bool>& is_held, const HarmonicModesOptions& options)
{
  const bool is_half = coordinates.symmetric.size() > 0;
  const HarmonicCoordinates c = solved_coordinates(coordinates);
  const std::vector<int> held = held_coordinates(c, is_held);
  HarmonicModes modes{.omega = {},
                      .multiplicity = is_half ? 2 : 1,
                      .motion = {.x = MatrixXd(c.X.rows(), 0), .y = MatrixXd(c.X.rows(), 0)}};
  const int most = (c.n() - static_cast<int>(held.size())) / 3, n = std::min(options.n_modes, most);
  if (n == 0) return modes;
  const petsc::Matrix K = as_matrix(harmonic_form(sector.K, c), Symmetry::symmetric),
                      M = as_matrix(harmonic_form(sector.M, c), Symmetry::symmetric);
  const reduce::NaturalModes found = reduce::natural_modes(
      K, M, reduce::free_dofs(K, held),
      {.n_modes = n, .n_rigid = std::min(options.n_rigid, n), .solver = options.solver});
  const MatrixXd X = first_columns(found.X, n);
  modes.omega.resize(n);
  for (int i = 0; i < n; ++i) {
    modes.omega[i] =
        i < options.n_rigid ? 0.0 : std::sqrt(std::max(found.lambda[std::size_t(i)], 0.0));
  }
  modes.motion = {.x = c.X * X, .y = c.Y * X};
  return modes;
}

bool all_modes_lie_above(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                         const std::vector<bool>& is_held, double omega)
{
  constexpr double margin = 1e-6;
  const HarmonicCoordinates c = solved_coordinates(coordinates);
  const double end = omega * (1.0 + margin);
  const SparseRows shifted = harmonic_form(sector.K, c) - end * end * harmonic_form(sector.M, c);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(
      lower_without(shifted, held_coordinates(c, is_held)));
  return factor.info() == Eigen::Success;
}

}  // namespace chladni::cyclic
