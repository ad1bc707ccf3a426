#pragma once

#include <vector>

#include "linear/cholesky/supernodal/fronts.hpp"

namespace chladni::linear {

/// The rows of a matrix that this rank eliminates, gathered from the ranks that own them.
class GatheredRows {
 public:
  /// @param is_needed  [n rows]
  /// @note   Collective.
  GatheredRows(Mat A, const std::vector<char>& is_needed);
  ~GatheredRows();
  GatheredRows(const GatheredRows&) = delete;
  GatheredRows& operator=(const GatheredRows&) = delete;
  const MatrixRows& rows() const { return rows_; }

 private:
  Mat matrix_ = nullptr;
  Mat* gathered_ = nullptr;
  MatrixRows rows_{};
};

}  // namespace chladni::linear
