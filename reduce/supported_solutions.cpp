#include "reduce/supported_solutions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/petsc.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/lanczos/block_lanczos.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXd;

namespace {

petsc::Matrix free_block(Mat A, const FreeDofs& free)
{
  petsc::Matrix block;
  petsc::check(MatCreateSubMatrix(A, free.indices, free.indices, MAT_INITIAL_MATRIX, block.put()));
  return block;
}

/// The least K_ii / M_ii of the rows with mass: about the square of the wave speed over the
/// distance of the nodes.
double least_diagonal_ratio(Mat K, Mat M)
{
  const petsc::Vector k = linear::diagonal(K), m = linear::diagonal(M);
  PetscInt n = 0;
  petsc::check(VecGetLocalSize(k, &n));
  const PetscScalar *k_values = nullptr, *m_values = nullptr;
  petsc::check(VecGetArrayRead(k, &k_values));
  petsc::check(VecGetArrayRead(m, &m_values));
  double least = std::numeric_limits<double>::max();
  for (PetscInt i = 0; i < n; ++i)
    if (m_values[i] > 0.0 && k_values[i] > 0.0) least = std::min(least, k_values[i] / m_values[i]);
  petsc::check(VecRestoreArrayRead(k, &k_values));
  petsc::check(VecRestoreArrayRead(m, &m_values));
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, petsc::communicator(K));
  return least;
}

/// A positive definite K + mu M.
struct Shifted {
  petsc::Matrix A;
  linear::Factorization factor;
  double mu;
};

/// With mu as it is, or as much larger as K + mu M needs to be definite in spite of round-off: a
/// thin plate resists bending by less than that share of what resists its stretching.
Shifted shifted(Mat K, Mat M, double mu, const linear::SolverOptions& options)
{
  constexpr double step = 1e3;
  constexpr int attempts = 4;
  for (int attempt = 1;; ++attempt, mu *= step) {
    petsc::Matrix A = linear::shifted(K, M, -mu);
    try {
      linear::Factorization factor = linear::factorize(A, options);
      return {.A = std::move(A), .factor = std::move(factor), .mu = mu};
    } catch (const linear::FreeMotion&) {
      if (attempt == attempts) throw;
    }
  }
}

/// The first elastic eigenvalue, to a few per cent where it is not far below mu; from above.
double first_elastic(const Shifted& shift, Mat M, int n_rigid)
{
  constexpr double rough = 1e-2;
  const linear::EigenPairs pairs =
      linear::block_lanczos(shift.factor.factor(), M, {.n_pairs = n_rigid + 1, .tolerance = rough});
  if (std::ssize(pairs.lambda) <= n_rigid) return shift.mu;  // nothing but rigid motions
  return std::max(pairs.lambda[n_rigid] - shift.mu, 0.0);
}

/// Eigenvalues of this size against mu keep their digits and converge fast.
bool suits(double mu, double elastic)
{
  return elastic > 1e-3 * mu && elastic < 1e5 * mu;
}

/// K + mu M with mu near the first elastic eigenvalue. The waves between neighbouring nodes lie
/// twelve decades above it in a long beam, hardly one in a compact body: each guess is measured by
/// a few steps that see the order of the first elastic eigenvalue, and the next one is that.
Shifted near_first_elastic(Mat K, Mat M, const NaturalModesOptions& options)
{
  constexpr int most_guesses = 4;
  double mu = 1e-10 * least_diagonal_ratio(K, M);
  for (int guess = 1;; ++guess) {
    Shifted shift = shifted(K, M, mu, options.solver);
    if (guess == most_guesses) return shift;
    const double elastic = first_elastic(shift, M, options.n_rigid);
    if (suits(shift.mu, elastic)) return shift;
    mu = std::max(elastic, 1e-3 * shift.mu);
  }
}

/// The pairs of a body with rigid-body motions.
linear::EigenPairs free_pairs(Mat K, Mat M, const NaturalModesOptions& options)
{
  const Shifted shift = near_first_elastic(K, M, options);
  linear::EigenPairs pairs =
      linear::block_lanczos(shift.factor.factor(), M, {.n_pairs = options.n_modes});
  for (double& lambda : pairs.lambda) lambda -= shift.mu;
  return pairs;
}

linear::EigenPairs lowest_pairs(Mat K, Mat M, const NaturalModesOptions& options)
{
  if (options.n_rigid > 0) return free_pairs(K, M, options);
  const linear::Factorization factor = linear::factorize(K, options.solver);
  return linear::block_lanczos(factor.factor(), M, {.n_pairs = options.n_modes});
}

}  // namespace

petsc::Matrix of_all_dofs(Mat X, const FreeDofs& free, Mat K, PetscInt n)
{
  PetscInt n_local = 0, n_global = 0;
  petsc::check(MatGetLocalSize(K, &n_local, nullptr));
  petsc::check(MatGetSize(K, &n_global, nullptr));
  petsc::Matrix all;
  petsc::check(MatCreateDense(petsc::communicator(K), n_local, PETSC_DECIDE, n_global, n, nullptr,
                              all.put()));
  const std::vector<PetscInt> rows = petsc::own_rows(free.indices, K);
  const linear::LocalRows from(X);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(all, &values));
  std::fill_n(values, std::size_t(n_local) * n, 0.0);
  for (PetscInt j = 0; j < n; ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      values[rows[i] + std::size_t(j) * n_local] = from(static_cast<PetscInt>(i), j);
  petsc::check(MatDenseRestoreArrayWrite(all, &values));
  petsc::check(MatAssemblyBegin(all, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(all, MAT_FINAL_ASSEMBLY));
  return all;
}

FreeDofs free_dofs(Mat K, const std::vector<int>& held)
{
  PetscInt first = 0, last = 0, n = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  petsc::check(MatGetSize(K, &n, nullptr));
  if (std::ssize(held) >= n) throw Error("free_dofs: the supports hold all DOFs; nothing can move");
  std::vector<PetscInt> own;
  for (PetscInt i = first; i < last; ++i)
    if (!std::ranges::binary_search(held, i)) own.push_back(i);
  FreeDofs free;
  petsc::check(ISCreateGeneral(petsc::communicator(K), static_cast<PetscInt>(own.size()),
                               own.data(), PETSC_COPY_VALUES, free.indices.put()));
  return free;
}

StaticSolution static_solution(Mat K, Vec f, const FreeDofs& free,
                               const linear::SolverOptions& options)
{
  const petsc::Matrix K_ff = free_block(K, free);
  const linear::Factorization factor = linear::factorize(K_ff, options);
  StaticSolution solution;
  petsc::check(VecDuplicate(f, solution.u.put()));
  petsc::check(VecSet(solution.u, 0.0));
  Vec f_f = nullptr, u_f = nullptr;
  petsc::check(VecGetSubVector(f, free.indices, &f_f));
  petsc::check(VecGetSubVector(solution.u, free.indices, &u_f));
  petsc::check(KSPSolve(factor.solver(), f_f, u_f));
  petsc::check(VecRestoreSubVector(solution.u, free.indices, &u_f));
  petsc::check(VecRestoreSubVector(f, free.indices, &f_f));
  petsc::check(VecDuplicate(f, solution.reaction.put()));
  petsc::check(MatMult(K, solution.u, solution.reaction));
  petsc::check(VecAXPY(solution.reaction, -1.0, f));
  return solution;
}

petsc::Matrix static_solutions(Mat K, Mat F, const FreeDofs& free,
                               const linear::SolverOptions& options)
{
  const petsc::Matrix K_ff = free_block(K, free);
  const linear::Factorization factor = linear::factorize(K_ff, options);
  petsc::Matrix F_f;
  petsc::check(MatCreateSubMatrix(F, free.indices, nullptr, MAT_INITIAL_MATRIX, F_f.put()));
  const PetscInt n = linear::LocalRows(F).n_cols();
  const petsc::Matrix U_f = linear::uninitialized_dense(K_ff, n);
  petsc::check(MatMatSolve(factor.factor(), F_f, U_f));
  return of_all_dofs(U_f, free, K, n);
}

Eigen::VectorXd own_compliances(Mat K, const FreeDofs& free, const std::vector<PetscInt>& loaded,
                                const linear::SolverOptions& options)
{
  const petsc::Matrix K_ff = free_block(K, free);
  const linear::Factorization factor = linear::factorize(K_ff, options);
  const std::vector<PetscInt> own = petsc::own_indices(free.indices);
  const petsc::Matrix F = linear::uninitialized_dense(K_ff, std::ssize(loaded)),
                      U = linear::uninitialized_dense(K_ff, std::ssize(loaded));
  petsc::check(MatZeroEntries(F));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(F, &values));
  for (std::size_t j = 0; j < loaded.size(); ++j) {
    const auto at = std::ranges::lower_bound(own, loaded[j]);
    if (at != own.end() && *at == loaded[j])
      values[j * own.size() + static_cast<std::size_t>(at - own.begin())] = 1.0;
  }
  petsc::check(MatDenseRestoreArray(F, &values));
  petsc::check(MatMatSolve(factor.factor(), F, U));
  return linear::inner_product(F, U).diagonal();
}

NaturalModes natural_modes(Mat K, Mat M, const FreeDofs& free, const NaturalModesOptions& options)
{
  const petsc::Matrix K_ff = free_block(K, free);
  const petsc::Matrix M_ff = free_block(M, free);
  PetscInt n_free = 0;
  petsc::check(MatGetSize(K_ff, &n_free, nullptr));
  if (options.n_modes < 1 || options.n_modes > n_free) {
    throw Error(fmt::format("natural_modes: {} modes asked of {} free DOFs; give 1 to {}",
                            options.n_modes, n_free, n_free));
  }
  linear::EigenPairs pairs = lowest_pairs(K_ff, M_ff, options);
  if (std::ssize(pairs.lambda) < options.n_modes) {
    throw Error(fmt::format("natural_modes: {} of {} modes found; the mass allows no more",
                            pairs.lambda.size(), options.n_modes));
  }
  pairs.lambda.resize(options.n_modes);
  return {.lambda = std::move(pairs.lambda), .X = of_all_dofs(pairs.X, free, K, options.n_modes)};
}

namespace {

/// The free rows of the shapes.
petsc::Matrix free_rows(const ShapesNearModes& shapes, const FreeDofs& free, Mat K_ff)
{
  const MatrixXd rows = shapes.rows(petsc::own_indices(free.indices));
  petsc::Matrix X = linear::uninitialized_dense(K_ff, shapes.n_shapes);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  std::copy_n(rows.data(), rows.size(), values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

}  // namespace

ImprovedModes improved_modes(Mat K, Mat M, const FreeDofs& free, const ShapesNearModes& shapes,
                             double mu, const linear::SolverOptions& options)
{
  petsc::Matrix A = free_block(K, free);
  const petsc::Matrix M_ff = free_block(M, free);
  if (mu != 0.0) A = linear::shifted(A, M_ff, -mu);
  const linear::Factorization factor = linear::factorize(A, options);
  const petsc::Matrix MX = linear::sparse_product(M_ff, free_rows(shapes, free, A));
  const petsc::Matrix Y = linear::uninitialized_dense(A, shapes.n_shapes);
  petsc::check(MatMatSolve(factor.factor(), MX, Y));
  MatrixXd K_r = linear::inner_product(Y, MX);
  MatrixXd M_r = linear::inner_product(Y, linear::sparse_product(M_ff, Y));
  const Eigen::VectorXd scale = M_r.diagonal().cwiseSqrt().cwiseInverse();
  M_r = scale.asDiagonal() * M_r * scale.asDiagonal();
  K_r = scale.asDiagonal() * K_r * scale.asDiagonal();
  K_r = MatrixXd(0.5 * (K_r + K_r.transpose()));
  M_r = MatrixXd(0.5 * (M_r + M_r.transpose()));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> pairs(K_r, M_r);
  petsc::Matrix X = linear::uninitialized_dense(A, shapes.n_shapes);
  petsc::check(MatZeroEntries(X));
  linear::add_product(1.0, Y, scale.asDiagonal() * pairs.eigenvectors(), X);
  return {.lambda = (pairs.eigenvalues().array() - mu).matrix(),
          .shares = pairs.eigenvectors().cwiseAbs2(),
          .X = std::move(X)};
}

}  // namespace chladni::reduce
