#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linear/kernels/borrowed_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/ghost_rows.hpp"

namespace chladni::linear {

/// The columns of [X_1 X_2 ...] in the rows of this rank and of ghosts, in parts: rows with the
/// columns that are not zero there.
class FormBasis {
 public:
  struct Column {
    const double* values;  ///< in the rows of this rank
    PetscInt number;       ///< among the columns of all X
  };

  /// @param coupled  AIJ, with the rows of X: its decoupled sets of rows are the parts
  /// @param ghosts   global rows of other ranks, ascending
  /// @note   Collective.
  FormBasis(std::span<const Mat> X, Mat coupled, const std::vector<PetscInt>& ghosts);

  PetscInt n_rows() const { return n_rows_; }
  PetscInt n_columns() const { return n_columns_; }
  int n_parts() const { return static_cast<int>(columns_.size()); }
  const std::vector<Column>& columns(int part) const { return columns_[std::size_t(part)]; }
  /// The part of a row; ghosts come behind the rows of this rank.
  int part(PetscInt row) const { return part_of_row_[std::size_t(row)]; }
  /// Some of the columns of a part, at most sixteen, in some rows: a panel row by row.
  void pack(std::span<const Column> columns, std::span<const PetscInt> rows, double* panel) const;
  /// All columns of a part in some rows of this rank.
  Eigen::MatrixXd values(int part, std::span<const PetscInt> rows) const;

 private:
  void take_ghosts(const GhostRows& exchange);

  std::vector<std::unique_ptr<LocalRows>> locals_;
  PetscInt n_rows_ = 0, n_columns_ = 0;
  std::vector<std::vector<Column>> columns_;  ///< [parts]
  std::vector<int> part_of_row_;
  Eigen::MatrixXd ghosts_;  ///< [ghosts x columns]
};

}  // namespace chladni::linear
