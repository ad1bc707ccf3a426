#include "linear/lanczos/block_basis.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>

#include "linear/kernels/scratch.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::linear {

namespace {

/// Dense matrix on given storage, or on its own.
petsc::Matrix dense(MPI_Comm comm, PetscInt n_local, PetscInt n_global, PetscInt n_columns,
                    double* values)
{
  petsc::Matrix A;
  petsc::check(MatCreateDense(comm, n_local, PETSC_DECIDE, n_global, n_columns, values, A.put()));
  return A;
}

}  // namespace

BlockBasis::BlockBasis(Mat M, PetscInt capacity, std::string scratch)
    : M_(M), product_with_M_(M), scratch_(std::move(scratch)), values_(scratch_)
{
  petsc::check(MatGetLocalSize(M, &n_local_, nullptr));
  petsc::check(MatGetSize(M, &n_global_, nullptr));
  reserve(capacity);
}

void BlockBasis::reserve(PetscInt capacity)
{
  if (capacity <= capacity_) return;
  if (scratch_.empty()) {
    const double untouched = double(n_local_) * (capacity - n_columns_);
    require_memory(
        untouched * sizeof(double) / bytes_in_MiB,
        fmt::format("block Lanczos: a basis of {} vectors of {} DOFs", capacity, n_global_),
        "ask for fewer modes, use more machines, -cms_scratch or -cms_lanczos_subspace",
        petsc::communicator(M_));
  }
  int lack = int(values_.grow(std::size_t(n_local_) * capacity));
  MPI_Allreduce(MPI_IN_PLACE, &lack, 1, MPI_INT, MPI_MAX, petsc::communicator(M_));
  if (Lack(lack) != Lack::none) {
    const std::string what = fmt::format("{} vectors of {} DOFs", capacity, n_global_);
    throw Error("block Lanczos: " + told(Lack(lack), what,
                                         "ask for fewer modes or a smaller -cms_lanczos_subspace",
                                         scratch_));
  }
  capacity_ = capacity;
}

petsc::Matrix BlockBasis::new_block(Eigen::Index n_columns) const
{
  return uninitialized_dense(M_, n_columns);
}

petsc::Matrix BlockBasis::take_block(Eigen::Index n_columns)
{
  if (spare_.empty() || LocalRows(spare_.back()).n_cols() != n_columns) return new_block(n_columns);
  petsc::Matrix block = std::move(spare_.back());
  spare_.pop_back();
  return block;
}

void BlockBasis::give_back(petsc::Matrix block)
{
  constexpr std::size_t most = 2;
  if (block == nullptr) return;
  const bool is_alike =
      spare_.empty() || LocalRows(spare_.back()).n_cols() == LocalRows(block).n_cols();
  if (!is_alike) spare_.clear();
  if (spare_.size() < most) spare_.push_back(std::move(block));
}

petsc::Matrix BlockBasis::new_vectors(Eigen::Index n_columns) const
{
  return large_dense(M_, static_cast<PetscInt>(n_columns), scratch_);
}

petsc::Matrix BlockBasis::columns(PetscInt first, PetscInt n_columns)
{
  return dense(petsc::communicator(M_), n_local_, n_global_, n_columns,
               values_.get() + std::size_t(first) * n_local_);
}

petsc::Matrix BlockBasis::times_mass(Mat X) const
{
  petsc::Matrix MX = new_block(LocalRows(X).n_cols());
  product_with_M_.apply(X, MX);
  return MX;
}

void BlockBasis::truncate(PetscInt n)
{
  n_columns_ = n;
  newest_M_ = {};
  second_last_M_ = {};
}

void BlockBasis::unite_newest(PetscInt n)
{
  second_last_M_ = {};
  newest_M_ = times_mass(columns(n_columns_ - n, n));
}

void BlockBasis::compress(const Eigen::MatrixXd& S, PetscInt n_first)
{
  constexpr PetscInt piece = 512;  // rows at a time, in place
  std::vector<double> rows(std::size_t(piece) * n_first);
  const auto n_kept = static_cast<PetscInt>(S.cols());
  for (PetscInt at = 0; at < n_local_; at += piece) {
    const PetscInt n = std::min(piece, n_local_ - at);
    for (PetscInt j = 0; j < n_first; ++j) {
      std::copy_n(values_.get() + at + std::size_t(j) * n_local_, n,
                  rows.data() + std::size_t(j) * n);
    }
    const PetscBLASInt m = n, columns = n_kept, k = n_first, ld = n_local_;
    const PetscScalar one = 1.0, zero = 0.0;
    BLASgemm_("N", "N", &m, &columns, &k, &one, rows.data(), &m, S.data(), &k, &zero,
              values_.get() + at, &ld);
  }
  const PetscInt n_behind = n_columns_ - n_first;
  std::copy_n(values_.get() + std::size_t(n_first) * n_local_, std::size_t(n_behind) * n_local_,
              values_.get() + std::size_t(n_kept) * n_local_);
  n_columns_ = n_kept + n_behind;
  second_last_M_ = {};
}

petsc::Matrix BlockBasis::combine(const Eigen::MatrixXd& S) const
{
  petsc::Matrix X = new_vectors(S.cols());
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  add_product(1.0, values_.get(), n_local_, S, 0.0, values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

}  // namespace chladni::linear
