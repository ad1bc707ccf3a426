#include "reduce/block_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace chladni::reduce {

namespace {

/// Deterministic numbers in (-1, 1) from the global row and the column (splitmix64).
double start_value(std::uint64_t row, std::uint64_t column)
{
  std::uint64_t z = row * 0x9E3779B97F4A7C15ULL + column * 0xD1B54A32D192ED03ULL + 1;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return 2.0 * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1.0;
}

void fill_with_start_values(Mat block)
{
  PetscScalar* values = nullptr;
  PetscInt first = 0, n_local = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(block, &first, nullptr));
  petsc::check(MatGetLocalSize(block, &n_local, nullptr));
  petsc::check(MatGetSize(block, nullptr, &n_columns));
  petsc::check(MatDenseGetArrayWrite(block, &values));
  for (PetscInt j = 0; j < n_columns; ++j) {
    for (PetscInt i = 0; i < n_local; ++i) {
      values[i + std::size_t(j) * n_local] = start_value(first + i, j);
    }
  }
  petsc::check(MatDenseRestoreArrayWrite(block, &values));
}

/// T bordered by the coefficients of a new block; symmetric by taking means.
SmallMatrix bordered(const SmallMatrix& T, const SmallMatrix& coefficients)
{
  const PetscInt n_old = T.n_rows, n = coefficients.n_rows;
  SmallMatrix result(n, n);
  for (PetscInt j = 0; j < n_old; ++j) {
    for (PetscInt i = 0; i < n_old; ++i) result(i, j) = T(i, j);
  }
  for (PetscInt j = n_old; j < n; ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      const double here = coefficients(i, j - n_old);
      const double there = i >= n_old ? coefficients(j, i - n_old) : here;
      result(i, j) = result(j, i) = 0.5 * (here + there);
    }
  }
  return result;
}

}  // namespace

BlockIteration::BlockIteration(Mat M, PetscInt block_size, PetscInt capacity)
    : block_size_(block_size), basis_(M, capacity)
{}

void BlockIteration::start(const BlockOperator& op)
{
  const petsc::Matrix random = basis_.new_block(std::min(block_size_, basis_.n_rows()));
  fill_with_start_values(random);
  petsc::Matrix block;
  petsc::check(MatDuplicate(random, MAT_DO_NOT_COPY_VALUES, block.put()));
  op(random, basis_.times_mass(random), block);
  basis_.append(block);
  if (basis_.n_columns() == 0) {
    throw Error("block Lanczos: the operator maps the start vectors to zero; is the mass zero?");
  }
}

void BlockIteration::step(const BlockOperator& op)
{
  const PetscInt n_new = basis_.n_columns() - n_old_;
  petsc::Matrix block = basis_.new_block(n_new);
  op(basis_.columns(n_old_, n_new), basis_.newest_times_mass(), block);
  n_old_ = basis_.n_columns();
  const BlockBasis::Appended appended = basis_.append(block);
  T_ = bordered(T_, appended.coefficients);
  R_ = appended.R;
}

void BlockIteration::order_ritz_values(const Order& before)
{
  ritz_ = symmetric_eigen(T_);
  order_.resize(n_old_);
  std::iota(order_.begin(), order_.end(), 0);
  std::ranges::stable_sort(
      order_, [&](PetscInt a, PetscInt b) { return before(ritz_.values[a], ritz_.values[b]); });
}

double BlockIteration::residual(PetscInt i) const
{
  double sum = 0.0;
  for (PetscInt a = 0; a < R_.n_rows; ++a) {
    double component = 0.0;
    for (PetscInt c = 0; c < R_.n_cols; ++c) {
      component += R_(a, c) * ritz_.vectors(n_old_ - R_.n_cols + c, order_[i]);
    }
    sum += component * component;
  }
  return std::sqrt(sum);
}

void BlockIteration::restart(PetscInt n)
{
  SmallMatrix S(n_old_, n);
  SmallMatrix T(n, n);
  for (PetscInt k = 0; k < n; ++k) {
    T(k, k) = theta(k);
    for (PetscInt i = 0; i < n_old_; ++i) S(i, k) = ritz_.vectors(i, order_[k]);
  }
  basis_.compress(S, n_old_);
  T_ = std::move(T);
  n_old_ = n;
}

SmallMatrix BlockIteration::ritz_coefficients(PetscInt first, PetscInt last) const
{
  SmallMatrix S(basis_.n_columns(), last - first);
  for (PetscInt k = 0; k < S.n_cols; ++k) {
    for (PetscInt i = 0; i < n_old_; ++i) S(i, k) = ritz_.vectors(i, order_[first + k]);
  }
  return S;
}

petsc::Matrix BlockIteration::ritz_vectors(PetscInt n) const
{
  return basis_.combine(ritz_coefficients(0, n));
}

petsc::Matrix BlockIteration::purified_vectors(PetscInt first, PetscInt last) const
{
  SmallMatrix S = ritz_coefficients(first, last);
  for (PetscInt k = 0; k < S.n_cols; ++k) {
    const PetscInt ritz = first + k;
    for (PetscInt a = 0; a < basis_.n_columns() - n_old_; ++a) {
      for (PetscInt c = 0; c < R_.n_cols; ++c) {
        S(n_old_ + a, k) +=
            R_(a, c) * ritz_.vectors(n_old_ - R_.n_cols + c, order_[ritz]) / theta(ritz);
      }
    }
    double norm = 0.0;  // in the M-orthonormal basis
    for (PetscInt i = 0; i < S.n_rows; ++i) norm += S(i, k) * S(i, k);
    for (PetscInt i = 0; i < S.n_rows; ++i) S(i, k) /= std::sqrt(norm);
  }
  return basis_.combine(S);
}

}  // namespace chladni::reduce
