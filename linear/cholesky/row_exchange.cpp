#include "linear/cholesky/row_exchange.hpp"

#include <algorithm>

#include "linear/kernels/gather.hpp"

namespace chladni::linear {

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
