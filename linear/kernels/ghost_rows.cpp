#include "linear/kernels/ghost_rows.hpp"

#include <algorithm>

#include "linear/kernels/gather.hpp"

namespace chladni::linear {

/// Asks the owners for the ghosts, which ascend and so stand by rank.
GhostRows::GhostRows(std::span<const PetscInt> ghosts, const PetscInt* first_rows, MPI_Comm comm)
    : comm_(comm), n_ghosts_(static_cast<PetscInt>(ghosts.size()))
{
  const int n_ranks = petsc::size(comm_);
  send_counts_.resize(n_ranks);
  receive_counts_.resize(n_ranks);
  for (int r = 0; r < n_ranks; ++r) {
    receive_counts_[r] = static_cast<int>(std::ranges::lower_bound(ghosts, first_rows[r + 1]) -
                                          std::ranges::lower_bound(ghosts, first_rows[r]));
  }
  MPI_Alltoall(receive_counts_.data(), 1, MPI_INT, send_counts_.data(), 1, MPI_INT, comm_);
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  send_rows_.resize(send_at.back());
  MPI_Alltoallv(ghosts.data(), receive_counts_.data(), receive_at.data(), MPIU_INT,
                send_rows_.data(), send_counts_.data(), send_at.data(), MPIU_INT, comm_);
  for (int& row : send_rows_) row -= first_rows[petsc::rank(comm_)];
}

void GhostRows::take(const double* own, PetscInt width, double* ghosts) const
{
  if (send_counts_.empty()) return;
  outbox_.resize(send_rows_.size() * width);
  for (std::size_t i = 0; i < send_rows_.size(); ++i)
    std::copy_n(own + std::size_t(send_rows_[i]) * width, width, outbox_.data() + i * width);
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  const RowType row(width);
  MPI_Alltoallv(outbox_.data(), send_counts_.data(), send_at.data(), row, ghosts,
                receive_counts_.data(), receive_at.data(), row, comm_);
}

}  // namespace chladni::linear
