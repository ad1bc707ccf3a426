#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

/// A growing set of vectors that are orthonormal in the inner product of a symmetric positive
/// semidefinite M, with rows distributed as those of M. All operations are collective and work by
/// blocks.
class BlockBasis {
 public:
  /// @param scratch  folder for files that hold the vectors; empty: they are in memory
  BlockBasis(Mat M, PetscInt capacity, std::string scratch = {});

  MPI_Comm comm() const { return petsc::communicator(M_); }
  PetscInt n_rows() const { return n_global_; }
  PetscInt n_columns() const { return n_columns_; }
  PetscInt capacity() const { return capacity_; }

  /// Keeps all columns from now on orthogonal to those of C, which are orthonormal in M.
  void exclude(petsc::Matrix C) { excluded_ = std::move(C); }
  /// block <- block - C C^T M block for the excluded columns C.
  void take_out_excluded(Mat block) const;
  /// Makes room for more columns. Existing columns are not copied: they stay, or are moved by
  /// pages.
  /// @throws chladni::Error when there is not enough memory.
  void reserve(PetscInt capacity);

  /// An empty dense matrix with the rows of the basis.
  petsc::Matrix new_block(Eigen::Index n_columns) const;
  /// The same for any number of columns: where the basis is.
  petsc::Matrix new_vectors(Eigen::Index n_columns) const;
  /// As `new_block`, in the memory of a block that was given back.
  petsc::Matrix take_block(Eigen::Index n_columns);
  /// Keeps the memory of a block for later ones of the same width: memory that is new each time
  /// costs more than the arithmetic on it.
  void give_back(petsc::Matrix block);
  /// Keeps it no longer: nothing is to be appended soon.
  void release_given_back() { spare_.clear(); }
  /// Columns of the basis without a copy; valid until the next append or compress.
  petsc::Matrix columns(PetscInt first, PetscInt n_columns);
  /// M X.
  petsc::Matrix times_mass(Mat X) const;

  /// The decomposition block = V coefficients + Q R of an appended block, with Q orthonormal and
  /// orthogonal to V.
  struct Appended {
    Eigen::MatrixXd coefficients;  ///< [n_columns before x columns of block]
    Eigen::MatrixXd R;             ///< [columns of Q x columns of block]
    /// [columns of block] length in M of the part of each column along directions that were left
    /// out.
    std::vector<double> left_out;
  };
  /// Adds Q to the basis. Directions that depend on the basis to round-off are left out: Q may have
  /// fewer columns than the block, or none.
  Appended append(Mat block);
  /// The directions of blocks that were left out since the last call because M times them has too
  /// few digits.
  std::vector<petsc::Matrix> take_lost() { return std::exchange(lost_, {}); }
  /// M times the columns that the last append added.
  Mat newest_times_mass() const { return newest_M_; }

  /// Makes the last n columns the newest block.
  void unite_newest(PetscInt n);
  /// Keeps the first n columns; afterwards there is no newest block.
  void truncate(PetscInt n);

  /// Replaces the first `n_first` columns V by V S; the columns after them move up.
  void compress(const Eigen::MatrixXd& S, PetscInt n_first);

  /// V S with all columns V.
  petsc::Matrix combine(const Eigen::MatrixXd& S) const;

 private:
  Eigen::MatrixXd project_out_newest(Mat block);
  Eigen::MatrixXd project_out(Mat block, Mat M_block);
  LongColumns local_columns(PetscInt first) const;
  void subtract_columns(PetscInt first, const Eigen::MatrixXd& S, Mat block) const;
  /// The decomposition of a block that joined the basis, as Appended, with all that was left out of
  /// it.
  struct Joined {
    Eigen::MatrixXd coefficients, R, left_out;
  };
  /// Columns grouped by the digits of M times them: six or more (resolved), fewer (others), and
  /// those of the latter with at least two (unsure).
  struct Chosen {
    std::vector<PetscInt> resolved, others, unsure;
  };
  Chosen by_digits_of_mass(PetscInt n);
  void clean(Joined& joined);
  void refuse_negative_length(Mat block, const Orthonormalisation& o) const;
  Joined join(Mat block, Mat M_block, const Eigen::MatrixXd& G, const std::vector<double>& sizes);
  Appended look_again(Mat block, Mat M_block, const Joined& first, Eigen::MatrixXd h,
                      const std::vector<double>& lengths);
  void store(Mat X, Mat MX, const Eigen::MatrixXd& to_Q);

  Mat M_;
  SparseProduct product_with_M_;
  PetscInt n_local_ = 0, n_global_ = 0;
  PetscInt capacity_ = 0;
  PetscInt n_columns_ = 0;
  petsc::Matrix excluded_;  ///< may be empty
  petsc::Matrix newest_M_;  ///< M times the last block
  std::vector<petsc::Matrix> lost_;
  petsc::Matrix second_last_M_;       ///< M times the block before; empty after compress
  std::vector<petsc::Matrix> spare_;  ///< blocks of one width
  std::string scratch_;
  GrowingMemory values_;  ///< [n_local x capacity] column-major, touched when used
};

}  // namespace chladni::linear
