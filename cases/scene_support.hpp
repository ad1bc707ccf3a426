#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/support.hpp"

namespace chladni::cases {

/// The support of the body of a scene, by names. Its rigid-body motions are those of the geometry.
class SceneSupport : public reduce::Support {
 public:
  /// @param described  nodes, sets and masters, in the order of `masters`
  /// @param masters    [n_m] global DOFs
  /// @param fixed      supports that hold masters
  SceneSupport(mbs_export::ReducedSystem described, const std::vector<PetscInt>& masters,
               std::vector<std::string> fixed);

  const std::vector<std::string>& fixed() const { return fixed_; }
  std::vector<PetscInt> held() const override;
  reduce::SupportedModes modes(const reduce::ReducedModel& model,
                               const reduce::SpectrumRange& wanted) const override;
  double zero_energy(const reduce::ReducedModel& model,
                     const reduce::SupportedModes& modes) const override;

 private:
  mbs_export::ReducedSystem described_;
  std::vector<PetscInt> masters_;
  std::vector<std::string> fixed_;
};

}  // namespace chladni::cases
