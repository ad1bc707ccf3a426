#include "linear/cholesky/petsc_factor.hpp"

#include <petsc/private/matimpl.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string_view>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/mumps_factor.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

namespace {

/// A factor without pivoting as long as the matrix is definite, and otherwise one by MUMPS with
/// pivoting. If pivots vanish or change sign, elimination in a given order amplifies round-off
/// without limit.
class PivotingFallback : public CholeskyFactor {
 public:
  PivotingFallback(std::unique_ptr<CholeskyFactor> definite, MPI_Comm comm);

  void analyze(Mat A) override;
  void factorize(Mat A) override;
  MatFactorError error() const override { return error_; }
  PetscInt n_negative_pivots() const override { return active().n_negative_pivots(); }
  bool is_reliable() const override { return active().is_reliable(); }
  void solve(LocalColumns X) override { active().solve(X); }
  void solve(const SparseColumns& B, LocalColumns X) override { active().solve(B, X); }
  PetscInt columns_at_a_time() const override { return active().columns_at_a_time(); }
  Memory forecast() const override { return active().forecast(); }
  FactorSize size() const override { return active().size(); }
  std::string description() const override;
  const CholeskyFactor& active() const override { return pivoting_ ? *pivoting_ : *definite_; }
  using CholeskyFactor::active;

 private:
  std::unique_ptr<CholeskyFactor> definite_;
  std::unique_ptr<CholeskyFactor> pivoting_;  ///< set while the matrix is indefinite
  MPI_Comm comm_;                             ///< of the matrix
  MatFactorError error_ = MAT_FACTOR_NOERROR;
};

PivotingFallback::PivotingFallback(std::unique_ptr<CholeskyFactor> definite, MPI_Comm comm)
    : definite_(std::move(definite)), comm_(comm)
{}

void PivotingFallback::analyze(Mat A)
{
  pivoting_.reset();
  definite_->analyze(A);
  error_ = definite_->error();
}

void PivotingFallback::factorize(Mat A)
{
  pivoting_.reset();
  definite_->factorize(A);
  error_ = definite_->error();
  if (definite_->is_reliable()) return;
  if (must_be_definite) {
    error_ = MAT_FACTOR_NUMERIC_ZEROPIVOT;
    return;
  }
  definite_->release();
  pivoting_ = std::make_unique<MumpsFactor>(comm_, Definiteness::unknown);
  pivoting_->analyze(A);
  error_ = pivoting_->error();
  if (error_ == MAT_FACTOR_NOERROR && !memory_need(comm_).fits()) error_ = MAT_FACTOR_OUTMEMORY;
  if (error_ != MAT_FACTOR_NOERROR) return;
  pivoting_->factorize(A);
  error_ = pivoting_->error();
}

std::string PivotingFallback::description() const
{
  if (!pivoting_) return definite_->description();
  return pivoting_->description() + "; with pivoting, since the matrix is indefinite";
}

/// MatGetInertia: signs of the pivots of L D L^T, all of them on the caller's ranks.
PetscErrorCode get_inertia(Mat F, PetscInt* n_negative, PetscInt* n_zero, PetscInt* n_positive)
{
  const CholeskyFactor& factor = factor_of(F);
  PetscCheck(factor.error() == MAT_FACTOR_NOERROR, PetscObjectComm((PetscObject)F),
             PETSC_ERR_MAT_CH_ZRPVT,
             "%s: a pivot is zero, so that the shift is an eigenvalue to round-off, or the memory "
             "does not suffice; there is no inertia: move the shift",
             F->solvertype);
  const PetscInt n = factor.n_negative_pivots();
  if (n_negative) *n_negative = n;
  if (n_zero) *n_zero = 0;  // they end the factorisation
  if (n_positive) *n_positive = F->rmap->N - n;
  return 0;
}

PetscErrorCode factorize(Mat F, Mat A, const MatFactorInfo*)
{
  return guarded([&] {
    factor_of(F).factorize(A);
    F->factorerrortype = factor_of(F).error();
    F->assembled = PETSC_TRUE;
    F->ops->solve = solve_vector;
    F->ops->solvetranspose = solve_vector;
    F->ops->matsolve = solve_block;
    F->ops->matsolvetranspose = solve_block;
    F->ops->mattransposesolve = solve_sparse;
  });
}

PetscErrorCode analyze(Mat F, Mat A, IS, const MatFactorInfo*)
{
  F->ops->choleskyfactornumeric = factorize;
  return guarded([&] {
    CholeskyFactor& factor = factor_of(F);
    factor.analyze(A);
    give_back_freed();  // the graphs of the ordering: more than K at times
    F->factorerrortype = factor.error();
    if (!factor.memory_need(petsc::communicator(A)).fits())
      F->factorerrortype = MAT_FACTOR_OUTMEMORY;
  });
}

PetscErrorCode destroy(Mat F)
{
  delete static_cast<CholeskyFactor*>(F->data);
  F->data = nullptr;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatFactorGetSolverType_C",
                                       nullptr));
  for (const char* method :
       {"MatMumpsGetInfog_C", "MatMumpsGetIcntl_C", "MatMumpsSetIcntl_C", "MatMumpsSetCntl_C"})
    PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), method, nullptr));
  return 0;
}

PetscErrorCode solver_type(Mat F, MatSolverType* type)
{
  *type = F->solvertype;
  return 0;
}

MumpsFactor& mumps_of(Mat F)
{
  return dynamic_cast<MumpsFactor&>(factor_of(F).active());
}

PetscErrorCode get_infog(Mat F, PetscInt index, PetscInt* value)
{
  *value = mumps_of(F).info(index);
  return 0;
}

PetscErrorCode get_icntl(Mat F, PetscInt index, PetscInt* value)
{
  *value = mumps_of(F).control(static_cast<int>(index));
  return 0;
}

PetscErrorCode set_icntl(Mat F, PetscInt index, PetscInt value)
{
  mumps_of(F).set_control(static_cast<int>(index), static_cast<int>(value));
  return 0;
}

PetscErrorCode set_cntl(Mat F, PetscInt index, PetscReal value)
{
  mumps_of(F).set_control(static_cast<int>(index), value);
  return 0;
}

PetscErrorCode get_info(Mat F, MatInfoType, MatInfo* info)
{
  *info = {};
  info->nz_used = info->nz_allocated = factor_of(F).size().entries;
  return 0;
}

PetscErrorCode view(Mat F, PetscViewer viewer)
{
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", factor_of(F).description().c_str()));
  return 0;
}

PetscErrorCode set_from_options(MumpsFactor& factor, MPI_Comm comm, const char* prefix)
{
  constexpr int n_integer = 40, n_real = 15;
  PetscFunctionBegin;
  PetscOptionsBegin(comm, prefix, "MUMPS ordered by METIS", "Mat");
  for (int i = 1; i <= n_integer; ++i) {
    PetscInt value = factor.control(i);
    PetscBool given = PETSC_FALSE;
    PetscCall(PetscOptionsInt(fmt::format("-mat_mumps_icntl_{}", i).c_str(),
                              fmt::format("ICNTL({}) of MUMPS' manual", i).c_str(), nullptr, value,
                              &value, &given));
    if (given) factor.set_control(i, static_cast<int>(value));
  }
  for (int i = 1; i <= n_real; ++i) {
    PetscReal value = factor.real_control(i);
    PetscBool given = PETSC_FALSE;
    PetscCall(PetscOptionsReal(fmt::format("-mat_mumps_cntl_{}", i).c_str(),
                               fmt::format("CNTL({}) of MUMPS' manual", i).c_str(), nullptr, value,
                               &value, &given));
    if (given) factor.set_control(i, value);
  }
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

/// As PETSc's own interface to MUMPS: pivoting unless the matrix is known to be definite.
std::unique_ptr<CholeskyFactor> new_mumps_factor(Mat A)
{
  const MPI_Comm comm = petsc::communicator(A);
  PetscBool is_known = PETSC_FALSE, is_definite = PETSC_FALSE;
  petsc::check(MatIsSPDKnown(A, &is_known, &is_definite));
  const Definiteness definiteness =
      is_known && is_definite ? Definiteness::positive : Definiteness::unknown;
  auto factor = std::make_unique<MumpsFactor>(comm, definiteness);
  const char* prefix = A->factorprefix ? A->factorprefix : reinterpret_cast<PetscObject>(A)->prefix;
  petsc::check(set_from_options(*factor, comm, prefix));
  return std::make_unique<PivotingFallback>(std::move(factor), comm);
}

std::unique_ptr<CholeskyFactor> new_supernodal_factor(Mat A)
{
  const MPI_Comm comm = petsc::communicator(A);
  return std::make_unique<PivotingFallback>(std::make_unique<SupernodalFactor>(comm), comm);
}

PetscErrorCode create_factor(Mat A, MatFactorType type, const char* name,
                             std::unique_ptr<CholeskyFactor> (*make)(Mat), Mat* F)
{
  Mat B = nullptr;
  PetscCall(MatCreate(petsc::communicator(A), &B));
  PetscCall(MatSetSizes(B, A->rmap->n, A->cmap->n, A->rmap->N, A->cmap->N));
  PetscCall(PetscStrallocpy(name, &reinterpret_cast<PetscObject>(B)->type_name));
  PetscCall(MatSetUp(B));
  PetscCall(guarded([&] { B->data = make(A).release(); }));
  B->ops->choleskyfactorsymbolic = analyze;
  B->ops->destroy = destroy;
  B->ops->view = view;
  B->ops->getinfo = get_info;
  B->ops->getinertia = get_inertia;
  B->factortype = type;
  B->canuseordering = PETSC_FALSE;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatFactorGetSolverType_C",
                                       solver_type));
  PetscCall(PetscFree(B->solvertype));
  PetscCall(PetscStrallocpy(name, &B->solvertype));
  *F = B;
  return 0;
}

PetscErrorCode create_mumps_metis(Mat A, MatFactorType type, Mat* F)
{
  PetscCall(create_factor(A, type, mumps_metis, new_mumps_factor, F));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*F), "MatMumpsGetInfog_C",
                                       get_infog));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*F), "MatMumpsGetIcntl_C",
                                       get_icntl));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*F), "MatMumpsSetIcntl_C",
                                       set_icntl));
  PetscCall(
      PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*F), "MatMumpsSetCntl_C", set_cntl));
  return 0;
}

PetscErrorCode create_supernodal(Mat A, MatFactorType type, Mat* F)
{
  PetscCall(create_factor(A, type, supernodal, new_supernodal_factor, F));
  return 0;
}

/// The C++ object behind a factor of our types, otherwise null.
CholeskyFactor* ours(Mat F)
{
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(F, &type));
  const bool is_ours =
      std::string_view(type) == mumps_metis || std::string_view(type) == supernodal;
  return is_ours ? &factor_of(F) : nullptr;
}

}  // namespace

bool is_ours(Mat F)
{
  return ours(F) != nullptr;
}

void set_budget(Mat F, const MemoryBudget& budget)
{
  if (CholeskyFactor* factor = ours(F)) factor->budget = budget;
}

void set_beside(Mat F, double beside_MiB, const SecondFactor& second)
{
  CholeskyFactor* factor = ours(F);
  if (factor == nullptr) return;
  factor->budget.beside_MiB = beside_MiB;
  factor->budget.second = second;
}

void require_definite(Mat F)
{
  if (CholeskyFactor* factor = ours(F)) factor->must_be_definite = true;
}

PetscInt our_negative_pivots(Mat F)
{
  return factor_of(F).n_negative_pivots();
}

FactorSize factor_size(Mat F)
{
  const CholeskyFactor* factor = ours(F);
  return factor ? factor->size() : FactorSize{.operations = 0.0, .entries = 0.0};
}

MemoryNeed memory_need(Mat F)
{
  const CholeskyFactor* factor = ours(F);
  return factor ? factor->memory_need(petsc::communicator(F)) : MemoryNeed{.needed_MiB = 0.0};
}

void register_cholesky_types()
{
  static bool registered = false;
  if (registered) return;
  // PETSc 3.18 reads its list of solvers before it fills it on the first call: it would forget all
  // of its own ones where this is that call, as under -dll_append.
  petsc::check(MatInitializePackage());
  for (const MatType type : {MATSEQAIJ, MATMPIAIJ}) {
    petsc::check(MatSolverTypeRegister(mumps_metis, type, MAT_FACTOR_CHOLESKY, create_mumps_metis));
    petsc::check(MatSolverTypeRegister(supernodal, type, MAT_FACTOR_CHOLESKY, create_supernodal));
  }
  petsc::check(PetscRegisterFinalize([]() -> PetscErrorCode {
    registered = false;  // PETSc forgets its list of solvers
    return 0;
  }));
  registered = true;
}

namespace {

/// The rows of B_t as columns, on rank 0.
SparseColumns columns_of_transpose(Mat B_t)
{
  const MPI_Comm comm = petsc::communicator(B_t);
  PetscInt first = 0, last = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(B_t, &first, &last));
  petsc::check(MatGetSize(B_t, &n_columns, nullptr));
  std::vector<int> lengths, rows;
  std::vector<double> values;
  for (PetscInt j = first; j < last; ++j) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* entries = nullptr;
    petsc::check(MatGetRow(B_t, j, &n, &columns, &entries));
    lengths.push_back(n);
    rows.insert(rows.end(), columns, columns + n);
    values.insert(values.end(), entries, entries + n);
    petsc::check(MatRestoreRow(B_t, j, &n, &columns, &entries));
  }
  lengths = gather(lengths, MPI_INT, comm);
  SparseColumns B{.n_columns = n_columns,
                  .starts = std::vector<int>(lengths.size() + 1, 0),
                  .rows = gather(rows, MPI_INT, comm),
                  .values = gather(values, MPI_DOUBLE, comm)};
  std::inclusive_scan(lengths.begin(), lengths.end(), B.starts.begin() + 1);
  return B;
}

/// Columns first to last of B, where it is.
SparseColumns slice(const SparseColumns& B, int first, int last)
{
  SparseColumns part{.n_columns = last - first, .starts = {}, .rows = {}, .values = {}};
  if (B.starts.size() < 2) return part;  // not on rank 0
  const int begin = B.starts[first], end = B.starts[last];
  for (int j = first; j <= last; ++j) part.starts.push_back(B.starts[j] - begin);
  part.rows.assign(B.rows.begin() + begin, B.rows.begin() + end);
  part.values.assign(B.values.begin() + begin, B.values.begin() + end);
  return part;
}

}  // namespace

CholeskyFactor& factor_of(Mat F)
{
  return *static_cast<CholeskyFactor*>(F->data);
}

PetscErrorCode solve_vector(Mat F, Vec b, Vec x)
{
  return guarded([&] {
    petsc::check(VecCopy(b, x));
    LocalColumns column{.values = nullptr, .leading_dimension = 0, .n_columns = 1};
    petsc::check(VecGetLocalSize(x, &column.leading_dimension));
    petsc::check(VecGetArray(x, &column.values));
    factor_of(F).solve(column);
    petsc::check(VecRestoreArray(x, &column.values));
  });
}

PetscErrorCode solve_block(Mat F, Mat B, Mat X)
{
  return guarded([&] {
    if (B != X) petsc::check(MatCopy(B, X, SAME_NONZERO_PATTERN));
    factor_of(F).solve(LocalArray(X).columns());
  });
}

PetscErrorCode solve_sparse(Mat F, Mat B_t, Mat X)
{
  return guarded([&] {
    CholeskyFactor& factor = factor_of(F);
    const SparseColumns B = columns_of_transpose(B_t);
    const LocalArray array(X);
    const LocalColumns all = array.columns();
    const int most = factor.columns_at_a_time();
    for (int first = 0; first < B.n_columns; first += most) {
      report_progress(double(first) / B.n_columns);
      const int last = std::min(first + most, B.n_columns);
      factor.solve(slice(B, first, last),
                   {.values = all.values + std::size_t(first) * all.leading_dimension,
                    .leading_dimension = all.leading_dimension,
                    .n_columns = last - first});
    }
  });
}

}  // namespace chladni::linear
