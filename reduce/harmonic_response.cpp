#include "reduce/harmonic_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>

#include "common/all_ranks.hpp"
#include "common/checked_count.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/lanczos/block_basis.hpp"
#include "linear/solver_options.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

namespace {

/// Largest |A v - e| over |A| |v| of the columns in the Frobenius norm.
double backward_error(Mat A, Mat V, Mat E)
{
  petsc::Matrix R = linear::uninitialized_dense(A, linear::LocalRows(V).n_cols());
  linear::SparseProduct(A).apply(V, R);
  petsc::check(MatAXPY(R, -1.0, E, SAME_NONZERO_PATTERN));
  double residual = 0.0, of_A = 0.0, of_V = 0.0;
  petsc::check(MatNorm(R, NORM_FROBENIUS, &residual));
  petsc::check(MatNorm(A, NORM_FROBENIUS, &of_A));
  petsc::check(MatNorm(V, NORM_FROBENIUS, &of_V));
  return residual / (of_A * of_V);
}

/// A solver with the factor L D L^T of a symmetric indefinite matrix, by MUMPS. After the values of
/// A have changed, KSPSetUp factors it again with the same elimination order.
/// @note   Collective.
/// Options: `-<prefix>mat_mumps_...`
petsc::LinearSolver indefinite_factor(Mat A, const linear::OptionSource& source)
{
  petsc::LinearSolver solver = linear::new_solver(petsc::communicator(A), source);
  PC pc = nullptr;
  petsc::check(KSPSetOperators(solver, A, A));
  petsc::check(KSPSetType(solver, KSPPREONLY));
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(KSPSetFromOptions(solver));
  linear::set_up_factor(pc, source);
  petsc::check(KSPSetUp(solver));
  return solver;
}

/// Solves A V = E for dense E and V with the rows of A.
/// @return true if there is a factor and |A V - E| < 1e-12 |A| |V| in the Frobenius norm
/// @note   Collective.
bool solve_to_round_off(KSP solver, Mat E, Mat V)
{
  PC pc = nullptr;
  Mat factor = nullptr, A = nullptr;
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  petsc::check(KSPGetOperators(solver, &A, nullptr));
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  petsc::check(MatZeroEntries(V));
  if (error != MAT_FACTOR_NOERROR) return false;
  petsc::check(MatMatSolve(factor, E, V));
  constexpr double round_off = 1e-12;
  return backward_error(A, V, E) < round_off;
}

using Complex = std::complex<double>;

petsc::Matrix free_part(Mat A, const FreeDofs& free)
{
  petsc::Matrix block;
  petsc::check(MatCreateSubMatrix(A, free.indices, free.indices, MAT_INITIAL_MATRIX, block.put()));
  return block;
}

/// Entries wherever one of the matrices has some.
petsc::Matrix union_of(Mat K, Mat M, Mat C)
{
  petsc::Matrix all;
  petsc::check(MatDuplicate(K, MAT_COPY_VALUES, all.put()));
  petsc::check(MatAXPY(all, 1.0, M, DIFFERENT_NONZERO_PATTERN));
  if (C != nullptr) petsc::check(MatAXPY(all, 1.0, C, DIFFERENT_NONZERO_PATTERN));
  return all;
}

/// A with the entries of `pattern`, which has them all.
petsc::Matrix spread(Mat A, Mat pattern)
{
  petsc::Matrix wide;
  petsc::check(MatDuplicate(pattern, MAT_DO_NOT_COPY_VALUES, wide.put()));
  petsc::check(MatZeroEntries(wide));
  if (A != nullptr) petsc::check(MatAXPY(wide, 1.0, A, SUBSET_NONZERO_PATTERN));
  return wide;
}

/// @throws chladni::Error on all ranks when blocks on all entries are more than PETSc counts.
void check_counts(Mat pattern, PetscInt width)
{
  PetscInt n = 0;
  MatInfo of_rank{};
  petsc::check(MatGetSize(pattern, &n, nullptr));
  petsc::check(MatGetInfo(pattern, MAT_LOCAL, &of_rank));
  checked_count(std::int64_t{width} * n, "unknowns of a damped model", "use a coarser mesh");
  on_all_ranks(petsc::communicator(pattern), [&] {
    return checked_count(std::int64_t{width} * width * std::int64_t(of_rank.nz_used),
                         "entries of the dynamic stiffness on one rank", "use more ranks");
  });
}

/// An empty matrix with a block of `width` x `width` for each entry of `pattern`.
petsc::Matrix blocks_on(Mat pattern, PetscInt width)
{
  check_counts(pattern, width);
  PetscInt n = 0, first = 0, last = 0;
  petsc::check(MatGetLocalSize(pattern, &n, nullptr));
  petsc::check(MatGetOwnershipRange(pattern, &first, &last));
  std::vector<PetscInt> own, others;  // entries of each row, in columns of this rank and of others
  for (PetscInt row = first; row < last; ++row) {
    PetscInt n_own = 0, n_all = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(pattern, row, &n_all, &columns, nullptr));
    for (PetscInt k = 0; k < n_all; ++k) n_own += columns[k] >= first && columns[k] < last;
    const PetscInt n_others = n_all - n_own;
    petsc::check(MatRestoreRow(pattern, row, &n_all, &columns, nullptr));
    own.insert(own.end(), width, width * n_own);
    others.insert(others.end(), width, width * n_others);
  }
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(petsc::communicator(pattern), width * n, width * n, PETSC_DETERMINE,
                            PETSC_DETERMINE, 0, own.data(), 0, others.data(), A.put()));
  return A;
}

/// Where the free DOFs are among the rows of their block.
class FreeRows {
 public:
  FreeRows(const FreeDofs& free, Mat block)
  {
    petsc::check(MatGetOwnershipRange(block, &first_, nullptr));
    dofs_ = petsc::own_indices(free.indices);
  }

  /// Of a DOF that this rank owns and nothing holds.
  std::optional<PetscInt> local(PetscInt dof) const
  {
    const auto found = std::ranges::lower_bound(dofs_, dof);
    if (found == dofs_.end() || *found != dof) return std::nullopt;
    return static_cast<PetscInt>(found - dofs_.begin());
  }
  PetscInt first() const { return first_; }

 private:
  PetscInt first_ = 0;
  std::vector<PetscInt> dofs_;
};

/// One load in each column; its imaginary part is zero.
petsc::Matrix load_columns(Mat A, PetscInt width, const FreeRows& rows,
                           const std::vector<DofForm>& loads)
{
  petsc::Matrix E = linear::uninitialized_dense(A, std::ssize(loads));
  petsc::check(MatZeroEntries(E));
  for (std::size_t j = 0; j < loads.size(); ++j) {
    for (std::size_t k = 0; k < loads[j].dofs.size(); ++k) {
      const auto row = rows.local(loads[j].dofs[k]);
      if (!row) continue;
      petsc::check(MatSetValue(E, width * (rows.first() + *row), static_cast<PetscInt>(j),
                               loads[j].weights[k], ADD_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(E, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(E, MAT_FINAL_ASSEMBLY));
  return E;
}

/// The stored values of a row, to be given back at once: they are copied.
std::vector<double> row_values(Mat A, PetscInt row, std::vector<PetscInt>& columns)
{
  PetscInt n = 0;
  const PetscInt* at = nullptr;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetRow(A, row, &n, &at, &values));
  columns.assign(at, at + n);
  std::vector<double> copy(values, values + n);
  petsc::check(MatRestoreRow(A, row, &n, &at, &values));
  return copy;
}

/// [Re a, -Im a; -Im a, -Re a] of the entries of a row, or Re a of a model without damping.
void insert_row(Mat A, PetscInt width, PetscInt row, const std::vector<PetscInt>& columns,
                const std::vector<Complex>& a)
{
  const auto n = static_cast<PetscInt>(a.size());
  std::vector<PetscInt> at;
  std::vector<double> upper, lower;
  for (PetscInt k = 0; k < n; ++k) {
    const Complex value = a[static_cast<std::size_t>(k)];
    for (PetscInt part = 0; part < width; ++part) {
      at.push_back(width * columns[static_cast<std::size_t>(k)] + part);
      upper.push_back(part == 0 ? value.real() : -value.imag());
      lower.push_back(part == 0 ? -value.imag() : -value.real());
    }
  }
  for (PetscInt part = 0; part < width; ++part) {
    const PetscInt global = width * row + part;
    petsc::check(MatSetValues(A, 1, &global, static_cast<PetscInt>(at.size()), at.data(),
                              (part == 0 ? upper : lower).data(), INSERT_VALUES));
  }
}

}  // namespace

HarmonicResponse::HarmonicResponse(const HarmonicModel& model, const FreeDofs& free,
                                   const std::vector<DofForm>& loads,
                                   const std::vector<DofForm>& outputs, linear::OptionSource source)
    : width_(model.is_damped() ? 2 : 1),
      factors_(model),
      source_(std::move(source)),
      n_outputs_(std::ssize(outputs))
{
  const petsc::Matrix K = free_part(model.K, free), M = free_part(model.M, free);
  const petsc::Matrix C = model.C == nullptr ? petsc::Matrix() : free_part(model.C, free);
  const petsc::Matrix H = model.H == nullptr ? petsc::Matrix() : free_part(model.H, free);
  const petsc::Matrix undamped = union_of(K, M, C);
  const petsc::Matrix pattern = union_of(undamped, undamped, H);
  K_ = spread(K, pattern);
  M_ = spread(M, pattern);
  if (model.C != nullptr) C_ = spread(C, pattern);
  if (model.H != nullptr) H_ = spread(H, pattern);
  A_ = blocks_on(pattern, width_);
  const FreeRows rows(free, K_);
  E_ = load_columns(A_, width_, rows, loads);
  for (Index i = 0; i < n_outputs_; ++i) {
    const DofForm& form = outputs[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < form.dofs.size(); ++k)
      if (const auto row = rows.local(form.dofs[k]))
        shares_.push_back({i, width_ * *row, form.weights[k]});
  }
}

void HarmonicResponse::set_values(double Omega)
{
  const Complex of_K(1.0, factors_.loss_factor + Omega * factors_.beta);
  const Complex of_M(-Omega * Omega, Omega * factors_.alpha), of_C(0.0, Omega);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K_, &first, &last));
  std::vector<PetscInt> columns;
  for (PetscInt row = first; row < last; ++row) {
    const std::vector<double> K = row_values(K_, row, columns), M = row_values(M_, row, columns);
    std::vector<Complex> a(K.size());
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = of_K * K[k] + of_M * M[k];
    const auto add = [&](Mat A, Complex factor) {
      if (A == nullptr) return;
      const std::vector<double> values = row_values(A, row, columns);
      for (std::size_t k = 0; k < a.size(); ++k) a[k] += factor * values[k];
    };
    add(C_, of_C);
    add(H_, Complex(0.0, 1.0));
    insert_row(A_, width_, row, columns, a);
  }
  petsc::check(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY));
}

void HarmonicResponse::check_resonance(double Omega, Mat V) const
{
  if (width_ == 2) return;
  const petsc::Matrix K_V = linear::uninitialized_dense(V, linear::LocalRows(V).n_cols());
  linear::SparseProduct(K_).apply(V, K_V);
  const std::vector<double> elastic = linear::column_products(K_V, K_V),
                            loads = linear::column_products(E_, E_);
  constexpr double resonant = 1e8;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (elastic[j] < resonant * resonant * loads[j]) continue;
    throw Resonance(fmt::format("{:.9g} Hz is an undamped natural frequency of the model",
                                Omega / (2.0 * std::numbers::pi)));
  }
}

MatrixXcd HarmonicResponse::outputs_of(Mat V) const
{
  const linear::LocalRows v(V);
  MatrixXd re = MatrixXd::Zero(n_outputs_, v.n_cols()), im = re;
  for (const Share& share : shares_) {
    for (PetscInt j = 0; j < v.n_cols(); ++j) {
      re(share.output, j) += share.weight * v(share.row, j);
      if (width_ == 2) im(share.output, j) += share.weight * v(share.row + 1, j);
    }
  }
  linear::sum_over_ranks(linear::values_of(re), petsc::communicator(V));
  linear::sum_over_ranks(linear::values_of(im), petsc::communicator(V));
  return re + Complex(0.0, 1.0) * im;
}

MatrixXcd HarmonicResponse::at(double Omega)
{
  set_values(Omega);
  if (solver_) {
    petsc::check(KSPSetOperators(solver_, A_, A_));
    petsc::check(KSPSetUp(solver_));
  } else {
    solver_ = indefinite_factor(A_, source_.part("response_"));
  }
  const petsc::Matrix V = linear::uninitialized_dense(A_, linear::LocalRows(E_).n_cols());
  if (!solve_to_round_off(solver_, E_, V)) {
    throw Error(
        fmt::format("harmonic_response: the dynamic stiffness has no usable factor at {:.9g} Hz; "
                    "it is an undamped natural frequency, or the memory does not suffice",
                    Omega / (2.0 * std::numbers::pi)));
  }
  check_resonance(Omega, V);
  return outputs_of(V);
}

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
