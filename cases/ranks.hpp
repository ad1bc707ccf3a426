#pragma once

#include <mpi.h>

#include <functional>
#include <optional>
#include <vector>

/// The processes that mpirun started, for the time while PETSc runs.

namespace chladni::cases {

/// Rank of this process, and number of all processes.
int rank();
int n_ranks();

/// The sum, and the maximum, of x over all ranks.
/// @note   Collective.
double sum_over_ranks(double x);
double largest_of_ranks(double x);

/// The numbers of all ranks in one list, in the order of the ranks.
/// @note   Collective.
std::vector<double> joined(const std::vector<double>& own);

/// Calls `work` on the first rank, while the others wait.
/// @note   Collective.
/// @throws chladni::Error on all ranks, with the text of what `work` threw.
void on_first_rank(const std::function<void()>& work);

/// Groups of ranks, each of which reduces one harmonic of a body of equal sectors after the other.
/// The groups are independent; the ranks of a group share matrices, factor and vectors.
class HarmonicGroups {
 public:
  /// @param ranks_each  least number of ranks in a group, or all ranks; empty: as many groups as
  ///                    there are harmonics, or ranks
  /// @note   Collective on all ranks.
  HarmonicGroups(int n_harmonics, std::optional<int> ranks_each);
  ~HarmonicGroups();
  HarmonicGroups(const HarmonicGroups&) = delete;
  HarmonicGroups& operator=(const HarmonicGroups&) = delete;

  /// The communicator of this rank's group.
  MPI_Comm comm() const { return comm_; }
  /// The harmonics of this group, ascending.
  const std::vector<int>& own() const { return own_; }
  /// The rank that speaks for the group of a harmonic.
  int speaker(int order) const;
  /// True if this rank speaks for its group.
  bool speaks() const;

 private:
  int n_groups_, group_;
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<int> own_;
};

}  // namespace chladni::cases
