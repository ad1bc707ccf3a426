#pragma once

#include <memory>
#include <vector>

#include "linear/cholesky/supernodal/fronts.hpp"

namespace chladni::linear {

/// The rows of a matrix that this rank eliminates, gathered from the ranks that own them.
class GatheredRows {
 public:
  /// @param is_needed  [n rows]
  /// @param position   [n rows] in the elimination: of a row, the entries in columns that come
  ///                   before it are left out where rows are gathered
  /// @note   Collective.
  GatheredRows(Mat A, const std::vector<char>& is_needed, const std::vector<int>& position);
  ~GatheredRows();
  GatheredRows(const GatheredRows&) = delete;
  GatheredRows& operator=(const GatheredRows&) = delete;
  const MatrixRows& rows() const { return rows_; }

 private:
  void borrow(Mat A);
  void gather(Mat A, const std::vector<PetscInt>& rows, const std::vector<int>& position);

  Mat borrowed_ = nullptr;
  std::vector<PetscInt> starts_;
  std::unique_ptr<PetscInt[]> columns_;
  std::unique_ptr<PetscScalar[]> values_;
  MatrixRows rows_{};
};

}  // namespace chladni::linear
