#pragma once

#include <vector>

#include "reduce/support.hpp"

namespace chladni::reduce {

/// Some masters are held, or none. The zero-energy motions are those that K does not resist,
/// whatever they are.
class HeldMasters : public Support {
 public:
  HeldMasters() = default;  ///< none
  /// @param masters  `Body::masters`
  /// @param held     some of them, each once
  /// @throws chladni::Error for a DOF that is no master.
  HeldMasters(const std::vector<PetscInt>& masters, std::vector<PetscInt> held);

  std::vector<PetscInt> held() const override { return held_; }
  /// All modes that there are.
  /// @throws chladni::Error when K_r or M_r is not semidefinite.
  SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const override;
  double zero_energy(const ReducedModel& model, const SupportedModes& modes) const override;

 private:
  std::vector<PetscInt> held_;
  std::vector<int> rows_;  ///< of the models, ascending
};

}  // namespace chladni::reduce
