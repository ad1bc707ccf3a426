#pragma once

#include <mpi.h>

#include <map>
#include <vector>

#include "cases/harmonic_groups.hpp"
#include "cases/sector_mass.hpp"

namespace chladni::cases {

/// Exchanges the motions of harmonics between ranks. The coupling of a harmonic with lower ones is
/// computed by the rank that reduces it, and no rank keeps more motions than that needs.
class LentMotions {
 public:
  /// @param count   number of sectors
  /// @param n_dofs  number of DOFs of one sector
  /// @param groups  whose speakers have the motions; must outlive this object
  LentMotions(int count, int n_dofs, const HarmonicGroups& groups);
  /// Waits until the motions of this rank have been taken.
  ~LentMotions();
  LentMotions(const LentMotions&) = delete;
  LentMotions& operator=(const LentMotions&) = delete;

  /// Sends the motion of a harmonic of this rank and waits for those of lower ones. The speaker of
  /// the group must call it for all its harmonics in ascending order, even after an error, then
  /// without a motion.
  void exchange(int order, cyclic::SectorMotion motion);

  /// The motions of the last harmonic and of those that it may be coupled with.
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
