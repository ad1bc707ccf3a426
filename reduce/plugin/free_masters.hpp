#pragma once

#include "reduce/support.hpp"

namespace chladni::reduce::plugin {

/// No support: the zero-energy motions are those that K does not resist, whatever they are.
class FreeMasters : public Support {
 public:
  std::vector<PetscInt> held() const override { return {}; }
  /// All modes that there are.
  /// @throws chladni::Error when K_r or M_r is not semidefinite.
  SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const override;
  double zero_energy(const ReducedModel& model, const SupportedModes& modes) const override;
};

}  // namespace chladni::reduce::plugin
