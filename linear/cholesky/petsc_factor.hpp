#pragma once

#include <petscmat.h>

#include <exception>
#include <new>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"

namespace chladni::linear {

/// PETSc's names of our Cholesky factorisations, `-pc_factor_mat_solver_type <name>`: our own one
/// for plates and shells with many right-hand sides, and MUMPS with METIS' ordering.
inline constexpr const char* supernodal = "supernodal";
inline constexpr const char* mumps_metis = "mumps-metis";

/// Registers both with PETSc for AIJ matrices, once between its initialisation and its end. An
/// indefinite matrix is passed to MUMPS with pivoting, by supernodal as well. MatSolve, MatMatSolve
/// and MatMatTransposeSolve (sparse right-hand sides) take matrices distributed by rows as they
/// are. For mumps-metis the options `-<prefix>mat_mumps_icntl_<i>` and
/// `-<prefix>mat_mumps_cntl_<i>` are those of PETSc's own interface to MUMPS, and MatMumpsGetInfog
/// works on the factor.
/// @throws chladni::Error when PETSc fails.
void register_cholesky_types();

/// True if a factor is of one of these types. The functions below have no effect on others.
bool is_ours(Mat F);

/// Sets the memory for a factor. A symbolic factorisation that needs more on any machine ends with
/// MAT_FACTOR_OUTMEMORY.
void set_budget(Mat F, const MemoryBudget& budget);

/// Replaces the memory that the budget of a factor holds for other things.
void set_beside(Mat F, double beside_MiB, const SecondFactor& second);

/// Makes an indefinite matrix an error: its factorisation ends with MAT_FACTOR_NUMERIC_ZEROPIVOT
/// and the number of its negative pivots.
void require_definite(Mat F);

/// The number of negative pivots.
PetscInt our_negative_pivots(Mat F);

/// The size of a factor; zero for other types.
FactorSize factor_size(Mat F);

/// The need of the machine with the least reserve, during the factorisation and after it with what
/// comes beside the factor, by the symbolic factorisation. Zero for other types.
/// @note   Collective.
MemoryNeed memory_need(Mat F);

}  // namespace chladni::linear

/// The functions that PETSc calls on our Cholesky factors.

namespace chladni::linear {

/// The C++ object inside one of our factors.
CholeskyFactor& factor_of(Mat F);

/// Runs C++ inside a callback of PETSc. An exception becomes a PETSc error, with the code of the
/// PETSc call that failed, if one did.
template <typename Work>
PetscErrorCode guarded(const Work& work)
{
  try {
    work();
  } catch (const petsc::Failure& failure) {
    return PetscError(PETSC_COMM_SELF, __LINE__, PETSC_FUNCTION_NAME, __FILE__, failure.code,
                      PETSC_ERROR_REPEAT, " ");
  } catch (const std::bad_alloc&) {
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_MEM, "not enough memory for the factor");
  } catch (const std::exception& error) {
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", error.what());
  }
  return 0;
}

/// MatSolve: x = A^-1 b.
PetscErrorCode solve_vector(Mat F, Vec b, Vec x);
/// MatMatSolve: X = A^-1 B; X may be B.
PetscErrorCode solve_block(Mat F, Mat B, Mat X);
/// MatMatTransposeSolve: X = A^-1 B; the rows of the sparse B_t are the columns of B.
PetscErrorCode solve_sparse(Mat F, Mat B_t, Mat X);

/// Write access to the rows of a dense matrix on this rank, during the lifetime of this object.
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

/// Our own factor behind PETSc's `factor`; null if another package solves.
inline SupernodalFactor* supernodal_of(Mat factor)
{
  return is_ours(factor) ? dynamic_cast<SupernodalFactor*>(&factor_of(factor).active()) : nullptr;
}

}  // namespace chladni::linear
