#include "linear/cholesky/supernodal/fronts.hpp"

#include <petscblaslapack.h>
#include <petscsys.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "common/fitting_instructions.hpp"
#include "common/petsc.hpp"
#include "linear/kernels/gather.hpp"

namespace chladni::linear {

Fronts::Fronts(const AssemblyTree& tree, const MatrixRows& A)
    : tree_(tree),
      A_(A),
      places_(tree),
      children_(tree.n_supernodes()),
      left_over_(tree.n_supernodes())
{
  for (int s = 0; s < tree.n_supernodes(); ++s)
    if (tree.parent[s] != -1) children_[tree.parent[s]].push_back(s);
}

double* Fronts::left_over(int s)
{
  const std::size_t m = tree_.n_below[s];
  if (!left_over_[s])
    left_over_[s] = std::make_unique_for_overwrite<double[]>(m * m);  // NOLINT(*-avoid-c-arrays)
  return left_over_[s].get();
}

void Fronts::add_entries(int s)
{
  const std::size_t front = std::size_t(tree_.n_columns(s)) + tree_.n_below[s];
  places_.for_entries(A_, [&](int row, int column, double value) {
    columns_[std::size_t(row) + std::size_t(column) * front] += value;
  });
}

void Fronts::add_left_over(int child, int s)
{
  const std::span<const int> rows = tree_.below(child);
  const std::size_t m = rows.size(), w = tree_.n_columns(s), n_below = tree_.n_below[s];
  std::vector<std::size_t> place(m);
  for (std::size_t i = 0; i < m; ++i) place[i] = places_.place(rows[i]);
  for (std::size_t j = 0; j < m; ++j) {
    const double* from = left_over_[child].get() + j * m;
    double* to = place[j] < w ? columns_.data() + place[j] * (w + n_below)
                              : left_over_[s].get() + (place[j] - w) * n_below - w;
    for (std::size_t i = j; i < m; ++i) to[place[i]] += from[i];
  }
  left_over_[child].reset();
}

int Fronts::eliminate(int s)
{
  const std::span<const int> below = tree_.below(s);
  places_.enter(s);
  const int w = tree_.n_columns(s), m = static_cast<int>(below.size());
  const std::size_t n_numbers = std::size_t(w + m) * w;
  columns_.assign(n_numbers, 0.0);
  if (scaled_columns_.size() < n_numbers) scaled_columns_.resize(n_numbers);
  add_entries(s);
  if (m > 0) left_over(s);
  double kept = 0.0;
  for (const int child : children_[s]) {
    if (!left_over_[child]) continue;
    if (kept == 0.0) std::fill_n(left_over_[s].get(), std::size_t(m) * m, 0.0);
    kept = 1.0;
    add_left_over(child, s);
  }
  const FrontColumns front{
      .A = columns_.data(), .W = scaled_columns_.data(), .n_rows = w + m, .n_columns = w};
  const int n_negative = eliminate_columns(front);
  if (n_negative >= 0 && m > 0) subtract_from_rest(front, kept, left_over_[s].get());
  return n_negative;
}

double peak_of_left_overs(const AssemblyTree& tree, const std::vector<int>& supernodes)
{
  std::vector<double> waiting(tree.n_supernodes(), 0.0);  // of the children of each
  double now = 0.0, peak = 0.0;
  for (const int s : supernodes) {
    const double m = tree.n_below[s];
    now += m * m;
    peak = std::max(peak, now);
    now -= waiting[s];
    if (tree.parent[s] != -1) waiting[tree.parent[s]] += m * m;
  }
  return peak;
}

bool FrontPlaces::has(int position) const
{
  if (position < tree_.first_column[s_ + 1]) return true;
  const std::span<const int> below = tree_.below(s_);
  const int place = place_below_[position];
  return std::cmp_less(place, below.size()) && below[place] == position;
}

void FrontPlaces::refuse(int row, PetscInt column)
{
  throw Error(
      fmt::format("supernodal: row {} has an entry in column {} that the matrix of the symbolic "
                  "factorisation had not; call MatCholeskyFactorSymbolic for each new pattern",
                  row, column));
}

// needs the types of petscsys.h

namespace {

constexpr int panel_columns = 24;  // eliminated one by one
constexpr int block_columns = 64;  // of a lower triangle that are updated as a rectangle

CHLADNI_FITTING_INSTRUCTIONS
void subtract_multiple(double factor, const double* __restrict x, int n, double* __restrict y)
{
  for (int i = 0; i < n; ++i) y[i] -= factor * x[i];
}

/// y <- scale y - X Z^T with X [n x k] and Z [m x k], both of leading dimension ld.
struct Update {
  int n, m, k;
  const double* X;
  const double* Z;
  int ld;
};

void subtract_update(const Update& u, double scale, double* Y, int ldy)
{
  if (u.n == 0 || u.m == 0) return;
  const PetscBLASInt n = u.n, m = u.m, k = u.k, ld = u.ld, ld_Y = ldy;
  const double minus_one = -1.0;
  BLASgemm_("N", "T", &n, &m, &k, &minus_one, u.X, &ld, u.Z, &ld, &scale, Y, &ld_Y);
}

}  // namespace

int eliminate_columns(const FrontColumns& front)
{
  const int n = front.n_rows;
  const auto at = [n](int row, int column) { return row + std::size_t(column) * n; };
  int n_negative = 0;
  for (int first = 0; first < front.n_columns; first += panel_columns) {
    const int last = std::min(first + panel_columns, front.n_columns);
    for (int j = first; j < last; ++j) {
      const double pivot = front.A[at(j, j)];
      if (!(pivot > 0.0 || pivot < 0.0)) return -1;
      if (pivot < 0.0) ++n_negative;
      for (int i = j + 1; i < n; ++i) {
        front.W[at(i, j)] = front.A[at(i, j)];
        front.A[at(i, j)] /= pivot;
      }
      for (int c = j + 1; c < last; ++c)
        subtract_multiple(front.W[at(c, j)], front.A + at(c, j), n - c, front.A + at(c, c));
    }
    for (int c = last; c < front.n_columns; c += block_columns) {
      const int width = std::min(block_columns, front.n_columns - c);
      subtract_update(
          {n - c, width, last - first, front.A + at(c, first), front.W + at(c, first), n}, 1.0,
          front.A + at(c, c), n);
    }
  }
  return n_negative;
}

void subtract_from_rest(const FrontColumns& front, double scale, double* C)
{
  const int n_rest = front.n_rows - front.n_columns;
  for (int c = 0; c < n_rest; c += block_columns) {
    const int width = std::min(block_columns, n_rest - c), row = front.n_columns + c;
    subtract_update(
        {n_rest - c, width, front.n_columns, front.A + row, front.W + row, front.n_rows}, scale,
        C + c + std::size_t(c) * n_rest, n_rest);
  }
}

namespace {

/// Numbers for each rank, one rank after the other.
template <typename T>
struct ByRank {
  std::vector<T> numbers;
  std::vector<int> counts;
};

/// What came from all ranks, one after the other, in memory that nothing else has touched.
template <typename T>
struct Received {
  std::unique_ptr<T[]> numbers;
  std::vector<int> counts;

  std::span<const T> all() const { return {numbers.get(), std::size_t(offsets(counts).back())}; }
};

template <typename T>
Received<T> exchanged(const ByRank<T>& sent, MPI_Datatype type, MPI_Comm comm)
{
  Received<T> received{.numbers = {}, .counts = std::vector<int>(sent.counts.size())};
  MPI_Alltoall(sent.counts.data(), 1, MPI_INT, received.counts.data(), 1, MPI_INT, comm);
  const std::vector<int> from = offsets(sent.counts), to = offsets(received.counts);
  received.numbers = std::make_unique_for_overwrite<T[]>(std::size_t(to.back()));
  MPI_Alltoallv(sent.numbers.data(), sent.counts.data(), from.data(), type, received.numbers.get(),
                received.counts.data(), to.data(), type, comm);
  return received;
}

/// Rows, by the rank that owns them.
ByRank<PetscInt> by_owner(Mat A, const std::vector<PetscInt>& rows)
{
  const PetscInt* first_rows = nullptr;
  petsc::check(MatGetOwnershipRanges(A, &first_rows));
  ByRank<PetscInt> asked{.numbers = rows,
                         .counts = std::vector<int>(petsc::size(petsc::communicator(A)), 0)};
  std::size_t owner = 0;
  for (const PetscInt row : rows) {
    while (row >= first_rows[owner + 1]) ++owner;
    ++asked.counts[owner];
  }
  return asked;
}

}  // namespace

GatheredRows::GatheredRows(Mat A, const std::vector<char>& is_needed,
                           const std::vector<int>& position)
{
  std::vector<PetscInt> rows;
  rows_.place.assign(is_needed.size(), -1);
  for (std::size_t row = 0; row < is_needed.size(); ++row) {
    if (is_needed[row] == 0) continue;
    rows_.place[row] = static_cast<int>(rows.size());
    rows.push_back(static_cast<PetscInt>(row));
  }
  if (petsc::size(petsc::communicator(A)) == 1)
    borrow(A);
  else
    gather(A, rows, position);
}

void GatheredRows::borrow(Mat A)
{
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  petsc::check(
      MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done));
  if (!done) throw Error("supernodal: the matrix is not of type AIJ; convert it with MatConvert");
  petsc::check(MatSeqAIJGetArrayRead(A, &rows_.values));
  borrowed_ = A;
}

void GatheredRows::gather(Mat A, const std::vector<PetscInt>& rows,
                          const std::vector<int>& position)
{
  const MPI_Comm comm = petsc::communicator(A);
  const Received<PetscInt> asked = exchanged(by_owner(A, rows), MPIU_INT, comm);
  ByRank<PetscInt> lengths{.numbers = {}, .counts = asked.counts};
  ByRank<PetscInt> columns{.numbers = {}, .counts = {}};
  ByRank<PetscScalar> values;
  MatInfo own{};
  petsc::check(MatGetInfo(A, MAT_LOCAL, &own));
  const auto n_own = static_cast<std::size_t>(own.nz_used);
  columns.numbers.reserve(n_own);  // address space only: about half of it is used
  values.numbers.reserve(n_own);
  const PetscInt* row = asked.numbers.get();
  for (const int n_rows : asked.counts) {
    const std::size_t before = columns.numbers.size();
    for (const PetscInt* last = row + n_rows; row != last; ++row) {
      PetscInt n = 0, n_kept = 0;
      const PetscInt* row_columns = nullptr;
      const PetscScalar* row_values = nullptr;
      petsc::check(MatGetRow(A, *row, &n, &row_columns, &row_values));
      for (PetscInt k = 0; k < n; ++k) {
        if (position[row_columns[k]] < position[*row]) continue;
        columns.numbers.push_back(row_columns[k]);
        values.numbers.push_back(row_values[k]);
        ++n_kept;
      }
      petsc::check(MatRestoreRow(A, *row, &n, &row_columns, &row_values));
      lengths.numbers.push_back(n_kept);
    }
    columns.counts.push_back(static_cast<int>(columns.numbers.size() - before));
  }
  values.counts = columns.counts;
  const Received<PetscInt> of_rows = exchanged(lengths, MPIU_INT, comm);
  const std::span<const PetscInt> n_entries = of_rows.all();
  starts_.assign(n_entries.size() + 1, 0);
  std::inclusive_scan(n_entries.begin(), n_entries.end(), starts_.begin() + 1);
  columns_ = exchanged(columns, MPIU_INT, comm).numbers;
  values_ = exchanged(values, MPIU_SCALAR, comm).numbers;
  rows_.starts = starts_.data();
  rows_.columns = columns_.get();
  rows_.values = values_.get();
}

GatheredRows::~GatheredRows()
{
  if (borrowed_ == nullptr) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  MatSeqAIJRestoreArrayRead(borrowed_, &rows_.values);
  MatRestoreRowIJ(borrowed_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done);
}

}  // namespace chladni::linear
