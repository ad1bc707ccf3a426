#pragma once

#include <mpi.h>

#include <map>
#include <vector>

#include "cases/harmonic_groups.hpp"
#include "cases/sector_mass.hpp"

namespace chladni::cases {

/// Motions of harmonics that ranks lend each other: what a harmonic has in common with lower ones
/// is found by the rank that reduces it, and no rank keeps more motions than that needs.
class LentMotions {
 public:
  /// @param count   of the sectors
  /// @param n_dofs  of one sector
  /// @param groups  whose speakers have the motions; must outlive this
  LentMotions(int count, int n_dofs, const HarmonicGroups& groups);
  /// Waits until the motions of this rank have been taken.
  ~LentMotions();
  LentMotions(const LentMotions&) = delete;
  LentMotions& operator=(const LentMotions&) = delete;

  /// Hands on the motion of a harmonic of this rank, and waits for those of lower ones. To be
  /// called by the speaker of the group for all its harmonics in ascending order, whatever fails:
  /// without a motion after that.
  void exchange(int order, cyclic::SectorMotion motion);

  /// Of the last harmonic and of those that it may have something in common with.
  const MotionsOfHarmonics& motions() const { return motions_; }

 private:
  void lend(int order, int to);
  void borrow(int order);
  void forget_below(int order);

  int n_harmonics_, n_dofs_;
  const HarmonicGroups& groups_;
  MotionsOfHarmonics motions_;
  std::map<int, std::vector<MPI_Request>> lent_;
};

}  // namespace chladni::cases
