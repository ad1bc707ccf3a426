#include "linear/cholesky/mumps_factor.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "common/checked_count.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

namespace {

// MUMPS' jobs.
constexpr int job_begin = -1;
constexpr int job_end = -2;
constexpr int job_analyze = 1;
constexpr int job_factorize = 2;
constexpr int job_solve = 3;

// ICNTL, numbered as in MUMPS' manual.
constexpr int error_stream = 1;
constexpr int diagnostic_stream = 2;
constexpr int global_stream = 3;
constexpr int print_level = 4;
constexpr int ordering = 7;
constexpr int root_on_one_rank = 13;
constexpr int percent_of_room = 14;
constexpr int analysis_by_blocks = 15;
constexpr int entry_format = 18;
constexpr int right_hand_side_format = 20;
constexpr int solution_format = 21;
constexpr int columns_in_a_block = 27;

}  // namespace

MumpsFactor::MumpsFactor(MPI_Comm comm, Definiteness definiteness)
{
  MPI_Comm_dup(comm, &comm_);
  mumps_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(comm_));
  mumps_.par = 1;
  mumps_.sym = definiteness == Definiteness::positive ? 1 : 2;
  mumps_.job = job_begin;
  dmumps_c(&mumps_);
  for (const int stream : {error_stream, diagnostic_stream, global_stream})
    set_control(stream, 0);  // what went wrong is in INFOG
  set_control(print_level, 0);
  set_control(ordering, 1);  // ours
  set_control(analysis_by_blocks, 0);
  set_control(entry_format, 3);  // distributed
  set_control(root_on_one_rank, 1);
  constexpr int fastest_columns = 64;
  set_control(columns_in_a_block, fastest_columns);
}

MumpsFactor::~MumpsFactor()
{
  mumps_.job = job_end;
  dmumps_c(&mumps_);
  MPI_Comm_free(&comm_);
}

void MumpsFactor::call(int job)
{
  mumps_.job = job;
  dmumps_c(&mumps_);
}

void MumpsFactor::call_solve()
{
  const LogEvent event(Event::solution);
  call(job_solve);
  if (info(1) >= 0) return;
  throw Error(
      fmt::format("MUMPS: the solution of {} columns failed with INFOG(1) = {}, INFOG(2) = {}",
                  mumps_.nrhs, info(1), info(2)));
}

/// The upper triangle of the rows of this rank.
void MumpsFactor::load_entries(Mat A)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  row_indices_.clear();
  column_indices_.clear();
  values_.clear();
  MatInfo info;
  petsc::check(MatGetInfo(A, MAT_LOCAL, &info));
  const auto about_half = static_cast<std::size_t>(0.55 * info.nz_used) + std::size_t(last - first);
  row_indices_.reserve(about_half);
  column_indices_.reserve(about_half);
  values_.reserve(about_half);
  for (PetscInt row = first; row < last; ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(A, row, &n, &columns, &values));
    for (PetscInt k = 0; k < n; ++k) {
      if (columns[k] < row) continue;
      row_indices_.push_back(row + 1);
      column_indices_.push_back(columns[k] + 1);
      values_.push_back(values[k]);
    }
    petsc::check(MatRestoreRow(A, row, &n, &columns, &values));
  }
  loaded_ = state_of(A);
  mumps_.nnz_loc = std::ssize(values_);
  mumps_.irn_loc = row_indices_.data();
  mumps_.jcn_loc = column_indices_.data();
  mumps_.a_loc = values_.data();
}

void MumpsFactor::analyze(Mat A)
{
  const PetscInt* ranges = nullptr;
  PetscInt n = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatGetOwnershipRanges(A, &ranges));
  first_rows_.assign(ranges, ranges + petsc::size(comm_) + 1);
  const int rank = petsc::rank(comm_);
  own_rows_.resize(first_rows_[rank + 1] - first_rows_[rank]);
  std::iota(own_rows_.begin(), own_rows_.end(), first_rows_[rank] + 1);
  mumps_.n = n;
  std::vector<int> places;
  if (control(ordering) == 1) {
    const LogEvent event(Event::ordering);
    places = elimination_order(A);
  }
  const LogEvent event(Event::analysis);
  mumps_.perm_in = places.data();
  load_entries(A);
  call(job_analyze);
  mumps_.perm_in = nullptr;
}

CholeskyFactor::Memory MumpsFactor::forecast() const
{
  constexpr int all_of_this_rank = 15;  // INFO, in 10^6 bytes
  const double MiB = 1e6 * mumps_.info[all_of_this_rank - 1] / bytes_in_MiB;
  return {.factorization_MiB = MiB, .factor_MiB = MiB, .entries_MiB = MiB};
}

/// What went wrong, in PETSc's words.
MatFactorError MumpsFactor::error() const
{
  const int code = info(1);
  if (code >= 0) return MAT_FACTOR_NOERROR;
  if (code == -10 || code == -6 || code == -40) return MAT_FACTOR_NUMERIC_ZEROPIVOT;
  if (code == -7 || code == -8 || code == -9 || code == -11 || code == -13 || code == -19)
    return MAT_FACTOR_OUTMEMORY;
  return MAT_FACTOR_OTHER;
}

bool MumpsFactor::lacks_room() const
{
  return info(1) == -8 || info(1) == -9;
}

PetscInt MumpsFactor::n_negative_pivots() const
{
  constexpr int negative_pivots = 12;  // INFOG
  return info(negative_pivots);
}

bool MumpsFactor::is_reliable() const
{
  const bool pivots = mumps_.sym == 2;
  return pivots || (error() != MAT_FACTOR_NUMERIC_ZEROPIVOT && info(12) == 0);
}

/// On one rank MUMPS works in place, block by block; two of them between reports of progress.
PetscInt MumpsFactor::columns_at_a_time() const
{
  const int n_blocks = petsc::size(comm_) == 1 ? 2 : 1;
  const PetscInt fastest = n_blocks * std::max(control(columns_in_a_block), 1);
  return std::min(fastest, most_columns(static_cast<PetscInt>(own_rows_.size())));
}

FactorSize MumpsFactor::size() const
{
  constexpr int operations = 3;          // RINFOG
  constexpr int entries_of_factor = 29;  // INFOG; a large number in millions, with a minus
  const int entries = info(entries_of_factor);
  return {.operations = real_info(operations), .entries = entries < 0 ? -1e6 * entries : entries};
}

std::string MumpsFactor::description() const
{
  return fmt::format("MUMPS, ordering {}: {:.3g} operations, {} MiB on all ranks",
                     control(ordering) == 1 ? "by METIS" : "by MUMPS", real_info(3), info(19));
}

void MumpsFactor::factorize(Mat A)
{
  const LogEvent event(Event::factorization);
  if (values_.empty() || loaded_ != state_of(A)) load_entries(A);
  call(job_factorize);
  // Pivots that are put off need room that the analysis cannot foresee.
  constexpr int most_percent = 1000;
  while (lacks_room() && control(percent_of_room) < most_percent) {
    set_control(percent_of_room, 2 * std::max(control(percent_of_room), 20));
    call(job_factorize);
  }
  // Neither refinement nor error analysis is asked for: the entries are not needed again.
  row_indices_ = {};
  column_indices_ = {};
  values_ = {};
  mumps_.irn_loc = mumps_.jcn_loc = nullptr;
  mumps_.a_loc = nullptr;
  exchange_ = {};
  solution_rows_ = {};
}

/// As many columns at a time as MUMPS counts numbers of.
void MumpsFactor::solve(LocalColumns X)
{
  const PetscInt most = most_columns(X.leading_dimension);
  for (PetscInt first = 0; first < X.n_columns; first += most) {
    solve_at_once({.values = X.values + std::size_t(first) * X.leading_dimension,
                   .leading_dimension = X.leading_dimension,
                   .n_columns = std::min(most, X.n_columns - first)});
  }
}

/// The same on all ranks.
PetscInt MumpsFactor::most_columns(PetscInt leading_dimension) const
{
  std::array<PetscInt, 2> most_rows{leading_dimension, mumps_.info[22]};
  MPI_Allreduce(MPI_IN_PLACE, most_rows.data(), 2, MPIU_INT, MPI_MAX, comm_);
  const std::int64_t rows = std::max<PetscInt>(std::max(most_rows[0], most_rows[1]), 1);
  return static_cast<PetscInt>(std::max<std::int64_t>(largest_count / rows, 1));
}

void MumpsFactor::solve_at_once(LocalColumns X)
{
  mumps_.nrhs = X.n_columns;
  if (petsc::size(comm_) > 1) return solve_distributed(X);
  set_control(right_hand_side_format, 0);
  set_control(solution_format, 0);
  mumps_.rhs = X.values;
  mumps_.lrhs = X.leading_dimension;
  call_solve();
}

void MumpsFactor::solve_distributed(LocalColumns X)
{
  constexpr int distributed = 10;
  set_control(right_hand_side_format, distributed);
  mumps_.nloc_rhs = static_cast<int>(own_rows_.size());
  mumps_.irhs_loc = own_rows_.data();
  mumps_.rhs_loc = X.values;
  mumps_.lrhs_loc = X.leading_dimension;
  take_solution(X);
}

void MumpsFactor::take_solution(LocalColumns X)
{
  set_control(solution_format, 1);
  const int n_rows = mumps_.info[22];  // INFO(23): pivots eliminated here
  solution_.resize(std::max<std::size_t>(std::size_t(n_rows) * X.n_columns, 1));
  std::vector<int> rows(std::max(n_rows, 1));
  mumps_.sol_loc = solution_.data();
  mumps_.lsol_loc = std::max(n_rows, 1);
  mumps_.isol_loc = rows.data();
  call_solve();
  rows.resize(n_rows);
  int is_new = exchange_.send_counts.empty() || rows != solution_rows_ ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &is_new, 1, MPI_INT, MPI_MAX, comm_);
  if (is_new == 1) {
    exchange_ = plan_exchange(rows, first_rows_, comm_);
    solution_rows_ = std::move(rows);
  }
  exchange_rows(exchange_, solution_, mumps_.lsol_loc, X, comm_);
}

void MumpsFactor::solve(const SparseColumns& B, LocalColumns X)
{
  std::vector<int> starts(B.starts), rows(B.rows);
  std::vector<double> values(B.values);
  for (int& start : starts) ++start;
  for (int& row : rows) ++row;
  set_control(right_hand_side_format, 1);
  mumps_.nrhs = B.n_columns;
  mumps_.nz_rhs = static_cast<int>(values.size());
  mumps_.irhs_ptr = starts.data();
  mumps_.irhs_sparse = rows.data();
  mumps_.rhs_sparse = values.data();
  if (petsc::size(comm_) > 1) return take_solution(X);
  set_control(solution_format, 0);
  mumps_.rhs = X.values;
  mumps_.lrhs = X.leading_dimension;
  call_solve();
}

RowExchange plan_exchange(const std::vector<int>& rows, const std::vector<PetscInt>& first_rows,
                          MPI_Comm comm)
{
  const int n_ranks = petsc::size(comm);
  RowExchange plan{.send_rows = std::vector<int>(rows.size()),
                   .send_counts = std::vector<int>(n_ranks),
                   .receive_counts = std::vector<int>(n_ranks),
                   .receive_rows = {}};
  const auto owner = [&](int row) {
    return std::ranges::upper_bound(first_rows, row - 1) - first_rows.begin() - 1;
  };
  for (const int row : rows) ++plan.send_counts[owner(row)];
  const std::vector<int> send_at = offsets(plan.send_counts);
  std::vector<int> next(send_at.begin(), send_at.end() - 1);
  std::vector<int> sent_rows(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int at = next[owner(rows[i])]++;
    plan.send_rows[at] = static_cast<int>(i);
    sent_rows[at] = rows[i] - 1;
  }
  MPI_Alltoall(plan.send_counts.data(), 1, MPI_INT, plan.receive_counts.data(), 1, MPI_INT, comm);
  const std::vector<int> receive_at = offsets(plan.receive_counts);
  plan.receive_rows.resize(receive_at.back());
  MPI_Alltoallv(sent_rows.data(), plan.send_counts.data(), send_at.data(), MPI_INT,
                plan.receive_rows.data(), plan.receive_counts.data(), receive_at.data(), MPI_INT,
                comm);
  for (int& row : plan.receive_rows) row -= first_rows[petsc::rank(comm)];
  return plan;
}

void exchange_rows(const RowExchange& plan, const std::vector<double>& from,
                   PetscInt from_leading_dimension, LocalColumns to, MPI_Comm comm)
{
  // One column after the other: an MPI count is an int, and the buffers stay small.
  const std::vector<int> send_at = offsets(plan.send_counts);
  const std::vector<int> receive_at = offsets(plan.receive_counts);
  std::vector<double> out(plan.send_rows.size()), in(plan.receive_rows.size());
  for (PetscInt j = 0; j < to.n_columns; ++j) {
    const double* source = from.data() + std::size_t(j) * from_leading_dimension;
    double* target = to.values + std::size_t(j) * to.leading_dimension;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = source[plan.send_rows[i]];
    MPI_Alltoallv(out.data(), plan.send_counts.data(), send_at.data(), MPI_DOUBLE, in.data(),
                  plan.receive_counts.data(), receive_at.data(), MPI_DOUBLE, comm);
    for (std::size_t i = 0; i < in.size(); ++i) target[plan.receive_rows[i]] = in[i];
  }
}

}  // namespace chladni::linear
