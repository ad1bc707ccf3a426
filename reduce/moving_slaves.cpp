#include "reduce/moving_slaves.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/index_sets.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "reduce/block_rows.hpp"

namespace chladni::reduce {

namespace {

/// For each of some parts which columns are not zero in its rows, the same on every rank.
class Touched {
 public:
  Touched(std::size_t n_parts, PetscInt n_columns)
      : n_columns_(static_cast<std::size_t>(n_columns)), is_(n_parts * n_columns_, 0)
  {}
  void add(std::size_t part, PetscInt column) { is_[part * n_columns_ + std::size_t(column)] = 1; }
  void add(std::size_t part, const std::vector<PetscInt>& rows, const linear::LocalRows& X)
  {
    for (PetscInt j = 0; j < X.n_cols(); ++j)
      if (std::ranges::any_of(rows, [&](PetscInt i) { return X(i, j) != 0.0; })) add(part, j);
  }
  void of_all_ranks(MPI_Comm comm)
  {
    MPI_Allreduce(MPI_IN_PLACE, is_.data(), static_cast<int>(is_.size()), MPI_INT, MPI_MAX, comm);
  }
  bool operator()(std::size_t part, PetscInt column) const
  {
    return is_[part * n_columns_ + std::size_t(column)] != 0;
  }
  PetscInt n_columns() const { return static_cast<PetscInt>(n_columns_); }

 private:
  std::size_t n_columns_;
  std::vector<int> is_;
};

/// Parts of the slaves, and the masters and modes that move each.
struct Parts {
  std::vector<std::vector<PetscInt>> rows;  ///< of this rank, counted from its first
  Touched masters, modes;
};

Parts parts_of(const std::vector<petsc::IndexSet>& sets, const Blocks& M,
               const CraigBamptonBasis& Q_CB)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(M.ss, &first, &last));
  const linear::LocalRows Psi(Q_CB.Psi);
  Parts parts{.rows = {},
              .masters = Touched(sets.size(), Psi.n_cols()),
              .modes = Touched(sets.size(), Q_CB.n_modes())};
  std::vector<std::size_t> part_of(std::size_t(last - first));
  for (std::size_t p = 0; p < sets.size(); ++p) {
    parts.rows.push_back(petsc::own_rows(sets[p], M.ss));
    for (const PetscInt i : parts.rows.back()) part_of[std::size_t(i)] = p;
    parts.masters.add(p, parts.rows.back(), Psi);
    if (Q_CB.modes) parts.modes.add(p, parts.rows.back(), linear::LocalRows(Q_CB.modes->Phi));
  }
  linear::for_local_entries(M.sm, [&](PetscInt row, PetscInt column, double value) {
    if (value != 0.0) parts.masters.add(part_of[std::size_t(row - first)], column);
  });
  parts.masters.of_all_ranks(petsc::communicator(M.ss));
  parts.modes.of_all_ranks(petsc::communicator(M.ss));
  return parts;
}

/// Whether some masters move each part, at once or by modes that move several.
std::vector<char> moved(const Parts& parts, const std::vector<int>& moving)
{
  std::vector<char> is_moved(parts.rows.size(), 0);
  for (std::size_t p = 0; p < parts.rows.size(); ++p) {
    is_moved[p] =
        std::ranges::any_of(moving, [&](int master) { return parts.masters(p, master); }) ? 1 : 0;
  }
  for (std::size_t round = 1; round < parts.rows.size(); ++round)
    for (std::size_t p = 0; p < parts.rows.size(); ++p)
      for (std::size_t q = 0; q < parts.rows.size(); ++q)
        for (PetscInt k = 0; k < parts.modes.n_columns(); ++k)
          if (is_moved[p] != 0 && parts.modes(p, k) && parts.modes(q, k)) is_moved[q] = 1;
  return is_moved;
}

petsc::Matrix submatrix(Mat A, IS rows, IS columns)
{
  petsc::Matrix part;
  petsc::check(MatCreateSubMatrix(A, rows, columns, MAT_INITIAL_MATRIX, part.put()));
  return part;
}

std::vector<int> all(PetscInt n)
{
  std::vector<int> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

PetscInt first_row(Mat A)
{
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  return first;
}

}  // namespace

MovingSlaves::MovingSlaves(const linear::Factorization& K_ss, const Blocks& M,
                           const CraigBamptonBasis& Q_CB, const std::vector<int>& moving)
    : factor_(K_ss), M_(M), Q_CB_(Q_CB), masters_(all(linear::LocalRows(Q_CB.Psi).n_cols()))
{
  if (moving.empty() || !linear::solves_for_parts(K_ss.factor())) return;
  const std::vector<petsc::IndexSet> sets = linear::decoupled_rows(K_ss.matrix(), M.ss);
  if (sets.empty()) return;
  const Parts parts = parts_of(sets, M, Q_CB);
  const std::vector<char> is_moved = moved(parts, moving);
  if (std::ranges::all_of(is_moved, [](char is) { return is != 0; })) return;

  std::vector<PetscInt> own, global;
  for (std::size_t p = 0; p < parts.rows.size(); ++p)
    if (is_moved[p] != 0) own.insert(own.end(), parts.rows[p].begin(), parts.rows[p].end());
  std::ranges::sort(own);
  for (const PetscInt i : own) global.push_back(i + first_row(M.ss));
  petsc::check(ISCreateGeneral(petsc::communicator(M.ss), static_cast<PetscInt>(global.size()),
                               global.data(), PETSC_COPY_VALUES, rows_.put()));
  std::erase_if(masters_, [&](int master) {
    if (std::ranges::binary_search(moving, master)) return false;
    for (std::size_t p = 0; p < parts.rows.size(); ++p)
      if (is_moved[p] != 0 && parts.masters(p, master)) return false;
    return true;
  });
  K_ss_ = submatrix(K_ss.matrix(), rows_, rows_);
  M_ss_ = submatrix(M.ss, rows_, rows_);
  M_sm_ = submatrix(M.sm, rows_, nullptr);
  Psi_ = block_of(linear::LocalRows(Q_CB.Psi), own, masters_, K_ss_);
  solve_ = linear::part_solver(K_ss.factor(), rows_);
  form_ = linear::part_form(K_ss.factor(), rows_);
}

petsc::Matrix MovingSlaves::rows_of(Mat X) const
{
  const linear::LocalRows x(X);
  return block_of(x, petsc::own_rows(rows_, X), all(x.n_cols()), K_ss_);
}

petsc::Matrix MovingSlaves::of_all(Mat X, PetscInt first, PetscInt last) const
{
  const std::vector<PetscInt> own = petsc::own_rows(rows_, factor_.matrix());
  const linear::LocalRows x(X);
  petsc::Matrix every = linear::uninitialized_dense(factor_.matrix(), last - first);
  petsc::check(MatZeroEntries(every));
  const std::size_t n_local = linear::LocalRows(every).n_rows();
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(every, &values));
  for (PetscInt j = first; j < last; ++j)
    for (std::size_t i = 0; i < own.size(); ++i) {
      values[std::size_t(own[i]) + std::size_t(j - first) * n_local] =
          x(static_cast<PetscInt>(i), j);
    }
  petsc::check(MatDenseRestoreArray(every, &values));
  return every;
}

petsc::Matrix MovingSlaves::solution(Mat F) const
{
  petsc::Matrix z = linear::uninitialized_dense(F, linear::LocalRows(F).n_cols());
  if (are_all())
    petsc::check(MatMatSolve(factor_.factor(), F, z));
  else
    solve_(F, z);
  return z;
}

linear::InverseForm MovingSlaves::inverse_form(petsc::Matrix B) const
{
  return are_all() ? linear::inverse_form(factor_.factor(), std::move(B)) : form_(std::move(B));
}

petsc::Matrix columns_of(Mat X, std::span<const int> numbers)
{
  const linear::LocalRows x(X);
  petsc::Matrix some = linear::uninitialized_dense(X, std::ssize(numbers));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(some, &values));
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    std::copy_n(x.values() + std::size_t(numbers[j]) * std::size_t(x.leading_dimension()),
                x.n_rows(), values + j * std::size_t(x.n_rows()));
  }
  petsc::check(MatDenseRestoreArrayWrite(some, &values));
  return some;
}

}  // namespace chladni::reduce
