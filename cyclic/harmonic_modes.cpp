#include "cyclic/harmonic_modes.hpp"

#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "cyclic/sparse_rows.hpp"
#include "cyclic/symmetric_half.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd;

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
  const HarmonicCoordinates c = is_half ? symmetric_half(coordinates) : coordinates;
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

}  // namespace chladni::cyclic
