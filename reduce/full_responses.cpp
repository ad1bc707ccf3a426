#include "reduce/full_responses.hpp"

#include <algorithm>
#include <cmath>

#include "linear/kernels/shifted.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "linear/lanczos/block_basis.hpp"
#include "reduce/indefinite_factor.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// One unit load in each column.
petsc::Matrix unit_loads(Mat K, const std::vector<PetscInt>& loaded)
{
  petsc::Matrix E = linear::uninitialized_dense(K, static_cast<PetscInt>(loaded.size()));
  petsc::check(MatZeroEntries(E));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  for (std::size_t j = 0; j < loaded.size(); ++j) {
    if (loaded[j] < first || loaded[j] >= last) continue;
    petsc::check(MatSetValue(E, loaded[j], static_cast<PetscInt>(j), 1.0, INSERT_VALUES));
  }
  petsc::check(MatAssemblyBegin(E, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(E, MAT_FINAL_ASSEMBLY));
  return E;
}

/// V_s - Psi V_m: zero where the masters move.
petsc::Matrix beyond_constraint_modes(const CraigBamptonBasis& Q_CB, const DofPartition& dofs,
                                      Mat V)
{
  petsc::Matrix V_m, V_s;
  petsc::check(MatCreateSubMatrix(V, dofs.masters, nullptr, MAT_INITIAL_MATRIX, V_m.put()));
  petsc::check(MatCreateSubMatrix(V, dofs.slaves, nullptr, MAT_INITIAL_MATRIX, V_s.put()));
  linear::add_product(-1.0, Q_CB.Psi, linear::replicate(V_m), V_s);
  return V_s;
}

/// Columns of unit length in M, so that none is dropped for its unit.
void normalise(Mat X, Mat M)
{
  const petsc::Matrix M_X = linear::uninitialized_dense(M, linear::LocalRows(X).n_cols());
  linear::SparseProduct(M).apply(X, M_X);
  const MatrixXd G = linear::inner_product(X, M_X);
  PetscInt ld = 0, n_rows = 0;
  PetscScalar* rows = nullptr;
  petsc::check(MatGetLocalSize(X, &n_rows, nullptr));
  petsc::check(MatDenseGetLDA(X, &ld));
  petsc::check(MatDenseGetArray(X, &rows));
  for (PetscInt j = 0; j < G.cols(); ++j) {
    const double scale = G(j, j) > 0.0 ? 1.0 / std::sqrt(G(j, j)) : 0.0;
    for (PetscInt i = 0; i < n_rows; ++i) rows[i + std::size_t(j) * ld] *= scale;
  }
  petsc::check(MatDenseRestoreArray(X, &rows));
}

/// [A, B]
petsc::Matrix side_by_side(Mat A, Mat B, Mat rows_of)
{
  const linear::LocalRows a(A), b(B);
  petsc::Matrix both = linear::uninitialized_dense(rows_of, a.n_cols() + b.n_cols());
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(both, &values));
  for (const linear::LocalRows* part : {&a, &b}) {
    for (PetscInt j = 0; j < part->n_cols(); ++j, values += part->n_rows()) {
      std::copy_n(part->values() + std::size_t(j) * part->leading_dimension(), part->n_rows(),
                  values);
    }
  }
  values = nullptr;
  petsc::check(MatDenseRestoreArrayWrite(both, &values));
  return both;
}

/// How many of the new directions are more than what round-off left of vectors of unit length;
/// they come by falling length.
PetscInt genuine_directions(const MatrixXd& R)
{
  constexpr double round_off = 1e-9;
  PetscInt n = 0;
  for (; n < R.rows(); ++n) {
    double squared = 0.0;
    for (PetscInt j = 0; j < R.cols(); ++j) squared += R(n, j) * R(n, j);
    if (squared < round_off * round_off) break;
  }
  return n;
}

/// Ritz vectors and values of some columns of a basis.
struct Ritz {
  petsc::Matrix X;
  std::vector<double> lambda;
};

Ritz ritz_of(linear::BlockBasis& basis, PetscInt n_before, PetscInt n, Mat K)
{
  if (n == 0) return {.X = basis.new_block(0), .lambda = {}};
  const petsc::Matrix Q = basis.columns(n_before, n);
  const petsc::Matrix K_Q = basis.new_block(n);
  linear::SparseProduct(K).apply(Q, K_Q);
  linear::SymmetricEigen ritz =
      linear::symmetric_eigen(linear::inner_product(Q, K_Q), petsc::communicator(K));
  MatrixXd S = MatrixXd::Zero(basis.n_columns(), n);
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i) S(n_before + i, j) = ritz.vectors(i, j);
  return {.X = basis.combine(S), .lambda = std::move(ritz.values)};
}

petsc::Matrix responses(Mat K, Mat M, const HarmonicLoads& loads,
                        const linear::OptionSource& source)
{
  const auto& [Omega_0, loaded] = loads;
  const petsc::Matrix A = linear::shifted(K, M, Omega_0 * Omega_0);
  const petsc::LinearSolver solver = indefinite_factor(A, source.part("response_"));
  const petsc::Matrix E = unit_loads(K, loaded);
  petsc::Matrix V = linear::uninitialized_dense(K, static_cast<PetscInt>(loaded.size()));
  if (!solve_to_round_off(solver, E, V)) {
    throw Error(fmt::format(
        "full_responses: K - omega0^2 M has no usable factor at omega0 = {:.9g} rad/s; it is a "
        "frequency of the free model, or the memory does not suffice: choose another omega0",
        Omega_0));
  }
  return V;
}

}  // namespace

petsc::Matrix full_responses(Mat K, Mat M, double Omega_0, const std::vector<PetscInt>& loaded)
{
  return responses(K, M, {.Omega_0 = Omega_0, .loaded = loaded}, {});
}

petsc::Matrix full_responses(Mat K, Mat M, const std::vector<HarmonicLoads>& loads,
                             const linear::OptionSource& source)
{
  petsc::Matrix all = linear::uninitialized_dense(K, 0);
  for (const HarmonicLoads& each : loads) {
    const petsc::Matrix V = responses(K, M, each, source);
    all = side_by_side(all, V, K);
  }
  return all;
}

Enrichment enrich(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, const SlaveBlocks& ss,
                  Mat V)
{
  petsc::Matrix R = beyond_constraint_modes(Q_CB, dofs, V);
  normalise(R, ss.M);
  linear::BlockBasis basis(ss.M, Q_CB.n_modes() + linear::LocalRows(R).n_cols());
  if (Q_CB.modes) basis.append(Q_CB.modes->Phi);
  const PetscInt n_before = basis.n_columns();
  PetscInt n_added = genuine_directions(basis.append(R).R);
  MPI_Bcast(&n_added, 1, MPIU_INT, 0, petsc::communicator(V));  // round-off decides on one rank
  const Ritz ritz = ritz_of(basis, n_before, n_added, ss.K);
  Enrichment enriched{.modes = {}, .n_added = n_added};
  if (Q_CB.modes) enriched.modes.omega = Q_CB.modes->omega;
  for (const double lambda : ritz.lambda) enriched.modes.omega.push_back(std::sqrt(lambda));
  const petsc::Matrix none = basis.new_block(0);
  enriched.modes.Phi = side_by_side(Q_CB.modes ? Mat(Q_CB.modes->Phi) : Mat(none), ritz.X, ss.M);
  return enriched;
}

}  // namespace chladni::reduce
