#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

inline constexpr PetscInt narrow_panel = 8;  ///< columns side by side: a cache line
inline constexpr PetscInt wide_panel = 16;

/// Rows first to last - 1 of this rank.
struct RowSpan {
  PetscInt first, last;
  PetscInt size() const { return last - first; }
};

/// The arrays of a sparse matrix by rows.
struct Csr {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
  std::span<const PetscInt> row(PetscInt i) const
  {
    return {columns + starts[i], columns + starts[i + 1]};
  }
};

/// Y <- A panel in some rows, Y row by row like the panel, of narrow_panel or wide_panel columns.
/// @param n_alike  [rows of A] as `numbers_alike` gives it
void multiply_narrow(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                     double* Y);
void multiply_wide(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                   double* Y);

/// Y <- Y + A panel.
void add_narrow(const Csr& A, const RowSpan& rows, const double* panel, double* Y);
void add_wide(const Csr& A, const RowSpan& rows, const double* panel, double* Y);

/// Rows at which a square matrix may be cut, so that no entry joins those before with the others
/// and each piece has at least a sixteenth of the n rows.
std::vector<PetscInt> cuts(const Csr& A, PetscInt n);

/// How many of the n rows have the same columns from each one on, up to three: so many are
/// multiplied at a time.
std::vector<char> numbers_alike(const Csr& A, PetscInt n);

/// Products of a sparse matrix with blocks of columns, sixteen or eight columns per pass over the
/// matrix. The product is limited by memory traffic; the matrix is read a quarter as often as by
/// PETSc's MatMatMult of AIJ and dense matrices, and the result is not allocated anew. Consecutive
/// rows of a rank that are coupled to no others of it, as those of `reduce::order_slaves`, take
/// part only for columns that are not zero there.
class SparseProduct {
 public:
  /// @param A  kept by reference if it is of type AIJ, otherwise converted; must not change during
  ///           the lifetime of this object
  /// @note   Collective on the communicator of A.
  explicit SparseProduct(Mat A);
  ~SparseProduct();
  SparseProduct(const SparseProduct&) = delete;
  SparseProduct& operator=(const SparseProduct&) = delete;

  /// Y <- A X for dense X, Y whose rows are distributed as the columns and the rows of A.
  /// @note   Collective.
  void apply(Mat X, Mat Y) const;

 private:
  /// A sequential matrix of PETSc with its arrays borrowed.
  struct Rows {
    Mat matrix = nullptr;
    const PetscInt* starts = nullptr;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
  };
  /// Global columns of other ranks that the rows of this rank need, and the first one of each rank.
  struct Ghosts {
    const PetscInt* columns;
    const PetscInt* first;
  };
  /// Rows and columns of this rank that have entries with each other only.
  struct Segment {
    RowSpan rows, columns;
  };
  /// Which segments a column is not zero in, bit by bit.
  using Mask = std::uint32_t;
  /// Columns side by side, and where they are not all zero.
  struct Panel {
    std::span<const PetscInt> columns;
    PetscInt width;
    Mask is_active;
  };
  struct Pattern;
  static Rows borrow(Mat sequential);
  static void give_back(Rows& rows);
  void plan_exchange(const Ghosts& ghosts);
  void exchange(PetscInt width) const;
  const Pattern& pattern_of_own() const;
  std::vector<Segment> segments() const;
  std::vector<Mask> masks(const LocalRows& X) const;
  void multiply(const LocalRows& X, const Panel& panel, double* Y, PetscInt ldy) const;

  petsc::Matrix A_;  ///< AIJ
  MPI_Comm comm_;
  PetscInt n_rows_ = 0, n_columns_ = 0;  ///< of this rank
  PetscInt n_ghosts_ = 0;
  Rows own_, other_;  ///< columns of this rank, and of others (by place among the ghosts)
  std::vector<int> send_rows_, send_counts_, receive_counts_;
  AlignedNumbers panel_, product_;
  mutable std::vector<double> outbox_;
  mutable std::vector<Segment> segments_;  ///< found when they are first asked for
};

/// A X for a dense X with the rows of A.
/// @note   Collective.
petsc::Matrix sparse_product(Mat A, Mat X);

}  // namespace chladni::linear
