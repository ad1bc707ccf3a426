#pragma once

#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

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

}  // namespace chladni::linear
