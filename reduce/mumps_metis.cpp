#include "reduce/mumps_metis.hpp"

#include <petsc/private/matimpl.h>

#include <exception>
#include <memory>
#include <numeric>
#include <string_view>

#include "reduce/gather.hpp"
#include "reduce/mumps_factor.hpp"

namespace chladni::reduce {

namespace {

MumpsFactor& factor_of(Mat F)
{
  return *static_cast<MumpsFactor*>(F->data);
}

/// Runs C++ inside a callback of PETSc: an exception becomes PETSc's error.
template <typename Work>
PetscErrorCode guarded(const Work& work)
{
  try {
    work();
  } catch (const std::exception& error) {
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", error.what());
  }
  return 0;
}

/// Dense array of the rows of this rank, for writing, as long as it lives.
class LocalArray {
 public:
  explicit LocalArray(Mat dense) : dense_(dense)
  {
    petsc::check(MatDenseGetLDA(dense_, &columns_.leading_dimension));
    petsc::check(MatGetSize(dense_, nullptr, &columns_.n_columns));
    petsc::check(MatDenseGetArray(dense_, &columns_.values));
  }
  ~LocalArray() { MatDenseRestoreArray(dense_, &columns_.values); }
  LocalArray(const LocalArray&) = delete;
  LocalArray& operator=(const LocalArray&) = delete;
  LocalColumns columns() const { return columns_; }

 private:
  Mat dense_;
  LocalColumns columns_{};
};

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

PetscErrorCode solve_sparse(Mat F, Mat B_t, Mat X)
{
  return guarded([&] {
    MumpsFactor& factor = factor_of(F);
    const SparseColumns B = columns_of_transpose(B_t);
    const LocalArray array(X);
    const LocalColumns all = array.columns();
    constexpr int columns_at_a_time = 27;
    const int most = petsc::size(petsc::communicator(F)) == 1
                         ? B.n_columns  // MUMPS works in place, block by block
                         : std::max(factor.control(columns_at_a_time), 1);
    for (int first = 0; first < B.n_columns; first += most) {
      const int last = std::min(first + most, B.n_columns);
      factor.solve(slice(B, first, last),
                   {.values = all.values + std::size_t(first) * all.leading_dimension,
                    .leading_dimension = all.leading_dimension,
                    .n_columns = last - first});
    }
  });
}

/// What went wrong, in PETSc's words.
MatFactorError failure(int info)
{
  if (info >= 0) return MAT_FACTOR_NOERROR;
  if (info == -10 || info == -6 || info == -40) return MAT_FACTOR_NUMERIC_ZEROPIVOT;
  if (info == -7 || info == -8 || info == -9 || info == -11 || info == -13 || info == -19) {
    return MAT_FACTOR_OUTMEMORY;
  }
  return MAT_FACTOR_OTHER;
}

PetscErrorCode factorize(Mat F, Mat A, const MatFactorInfo*)
{
  return guarded([&] {
    factor_of(F).factorize(A);
    F->factorerrortype = failure(factor_of(F).info(1));
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
    MumpsFactor& factor = factor_of(F);
    factor.analyze(A);
    F->factorerrortype = failure(factor.info(1));
    if (factor.forecast_MiB() > factor.budget_MiB) F->factorerrortype = MAT_FACTOR_OUTMEMORY;
  });
}

PetscErrorCode destroy(Mat F)
{
  delete static_cast<MumpsFactor*>(F->data);
  F->data = nullptr;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatFactorGetSolverType_C",
                                       nullptr));
  PetscCall(
      PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatMumpsGetInfog_C", nullptr));
  return 0;
}

PetscErrorCode solver_type(Mat, MatSolverType* type)
{
  *type = mumps_metis;
  return 0;
}

PetscErrorCode get_infog(Mat F, PetscInt index, PetscInt* value)
{
  *value = factor_of(F).info(index);
  return 0;
}

/// MUMPS gives a large number of entries in millions, with a minus.
double n_entries(const MumpsFactor& factor)
{
  constexpr int entries_of_factor = 29;  // INFOG
  const int entries = factor.info(entries_of_factor);
  return entries < 0 ? -1e6 * entries : entries;
}

PetscErrorCode get_info(Mat F, MatInfoType, MatInfo* info)
{
  *info = {};
  info->nz_used = info->nz_allocated = n_entries(factor_of(F));
  return 0;
}

PetscErrorCode view(Mat F, PetscViewer viewer)
{
  const MumpsFactor& factor = factor_of(F);
  constexpr int ordering_used = 7;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "MUMPS, ordering %s: %.3g operations, %d MiB on all ranks\n",
                                   factor.control(ordering_used) == 1 ? "by METIS" : "by MUMPS",
                                   factor.real_info(3), factor.info(19)));
  return 0;
}

void set_from_options(MumpsFactor& factor, const char* prefix)
{
  constexpr int n_integer = 40, n_real = 15;
  for (int i = 1; i <= n_integer; ++i) {
    PetscInt value = 0;
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsGetInt(nullptr, prefix, fmt::format("-mat_mumps_icntl_{}", i).c_str(),
                                    &value, &given));
    if (given) factor.set_control(i, value);
  }
  for (int i = 1; i <= n_real; ++i) {
    PetscReal value = 0;
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsGetReal(nullptr, prefix, fmt::format("-mat_mumps_cntl_{}", i).c_str(),
                                     &value, &given));
    if (given) factor.set_control(i, value);
  }
}

PetscErrorCode create_factor(Mat A, MatFactorType type, Mat* F)
{
  Mat B = nullptr;
  PetscCall(MatCreate(petsc::communicator(A), &B));
  PetscCall(MatSetSizes(B, A->rmap->n, A->cmap->n, A->rmap->N, A->cmap->N));
  PetscCall(PetscStrallocpy(mumps_metis, &reinterpret_cast<PetscObject>(B)->type_name));
  PetscCall(MatSetUp(B));
  const PetscErrorCode code = guarded([&] {
    auto factor = std::make_unique<MumpsFactor>(petsc::communicator(A));
    set_from_options(*factor,
                     A->factorprefix ? A->factorprefix : reinterpret_cast<PetscObject>(A)->prefix);
    B->data = factor.release();
  });
  PetscCall(code);
  B->ops->choleskyfactorsymbolic = analyze;
  B->ops->destroy = destroy;
  B->ops->view = view;
  B->ops->getinfo = get_info;
  B->factortype = type;
  B->canuseordering = PETSC_FALSE;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatFactorGetSolverType_C",
                                       solver_type));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatMumpsGetInfog_C",
                                       get_infog));
  PetscCall(PetscFree(B->solvertype));
  PetscCall(PetscStrallocpy(mumps_metis, &B->solvertype));
  *F = B;
  return 0;
}

/// The C++ object behind a factor of our type, otherwise null.
MumpsFactor* ours(Mat F)
{
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(F, &type));
  return std::string_view(type) == mumps_metis ? &factor_of(F) : nullptr;
}

}  // namespace

void set_budget(Mat F, double MiB)
{
  if (MumpsFactor* factor = ours(F)) factor->budget_MiB = MiB;
}

FactorSize factor_size(Mat F)
{
  const MumpsFactor* factor = ours(F);
  if (factor == nullptr) return {.operations = 0.0, .entries = 0.0};
  constexpr int operations = 3;  // RINFOG
  return {.operations = factor->real_info(operations), .entries = n_entries(*factor)};
}

double forecast_MiB(Mat F)
{
  const MumpsFactor* factor = ours(F);
  return factor ? factor->forecast_MiB() : 0.0;
}

void register_mumps_metis()
{
  static bool registered = false;
  if (registered) return;
  for (const MatType type : {MATSEQAIJ, MATMPIAIJ}) {
    petsc::check(MatSolverTypeRegister(mumps_metis, type, MAT_FACTOR_CHOLESKY, create_factor));
  }
  registered = true;
}

}  // namespace chladni::reduce
