#pragma once

#include <mpi.h>

#include <optional>
#include <vector>

namespace chladni::cases {

/// Groups of ranks, of which each reduces one harmonic of a body of equal sectors after the other.
/// The groups have nothing to wait for; the ranks of a group share matrices, factor and vectors.
class HarmonicGroups {
 public:
  /// @param ranks_each  at least so many ranks in a group, or all; empty: as many as there are for
  ///                    each harmonic
  /// @note   Collective on all ranks.
  HarmonicGroups(int n_harmonics, std::optional<int> ranks_each);
  ~HarmonicGroups();
  HarmonicGroups(const HarmonicGroups&) = delete;
  HarmonicGroups& operator=(const HarmonicGroups&) = delete;

  /// Of the ranks of this rank's group.
  MPI_Comm comm() const { return comm_; }
  /// The harmonics of this group, ascending.
  const std::vector<int>& own() const { return own_; }
  /// The rank that speaks for the group which reduces a harmonic.
  int speaker(int order) const;
  /// Whether this rank speaks for its group.
  bool speaks() const;

 private:
  int n_groups_, group_;
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<int> own_;
};

}  // namespace chladni::cases
