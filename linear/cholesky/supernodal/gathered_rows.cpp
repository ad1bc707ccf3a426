#include "linear/cholesky/supernodal/gathered_rows.hpp"

namespace chladni::linear {

GatheredRows::GatheredRows(Mat A, const std::vector<char>& is_needed)
{
  std::vector<PetscInt> rows;
  for (std::size_t row = 0; row < is_needed.size(); ++row)
    if (is_needed[row] != 0) rows.push_back(static_cast<PetscInt>(row));
  matrix_ = A;
  if (petsc::size(petsc::communicator(A)) > 1) {
    petsc::IndexSet needed, all;
    petsc::check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(rows.size()), rows.data(),
                                 PETSC_USE_POINTER, needed.put()));
    petsc::check(
        ISCreateStride(PETSC_COMM_SELF, static_cast<PetscInt>(is_needed.size()), 0, 1, all.put()));
    IS row_set = needed, column_set = all;
    petsc::check(MatCreateSubMatrices(A, 1, &row_set, &column_set, MAT_INITIAL_MATRIX, &gathered_));
    matrix_ = gathered_[0];
  }
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  petsc::check(
      MatGetRowIJ(matrix_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done));
  if (!done) throw Error("supernodal: the matrix is not of type AIJ; convert it with MatConvert");
  petsc::check(MatSeqAIJGetArrayRead(matrix_, &rows_.values));
  rows_.place.assign(is_needed.size(), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) rows_.place[rows[i]] = static_cast<int>(i);
}

GatheredRows::~GatheredRows()
{
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  MatSeqAIJRestoreArrayRead(matrix_, &rows_.values);
  MatRestoreRowIJ(matrix_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done);
  if (gathered_ != nullptr) MatDestroySubMatrices(1, &gathered_);
}

}  // namespace chladni::linear
