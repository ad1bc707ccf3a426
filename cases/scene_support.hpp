#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/harmonic_response.hpp"
#include "reduce/response_errors.hpp"
#include "reduce/support.hpp"
#include "scene/scene.hpp"

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

/// The responses of a scene's body that its reduction keeps to a tolerance.
struct SceneResponses {
  reduce::ResponseGoal goal;
  /// "track.z" for all nodes of a set; filled on the first rank when the goal is called.
  std::shared_ptr<std::vector<std::string>> names;
};

/// True if a reduction of the scene may have to keep responses.
bool may_keep_responses(const scene::Scene& scene);

/// The responses of `[body] keep` with a tolerance, if the loads act on masters. The reduction may
/// use a third of the tolerance, the body the rest. Absent without a tolerance.
/// @param described  nodes, sets and masters, in the order of `masters`
/// @param masters    [n_m] global DOFs
/// @param fixed      supports that hold masters
std::optional<SceneResponses> scene_responses(const scene::Scene& scene,
                                              mbs_export::ReducedSystem described,
                                              std::vector<PetscInt> masters,
                                              const std::vector<std::string>& fixed);

/// True if an interface mode of the scene is to be computed in the whole model.
bool wants_full_responses(const scene::Scene& scene);

/// The loads of these interface modes and the forces of the scene's supports, at their omega0. If
/// the reduced model contains the responses of the whole free model to them, a body has the same
/// responses as the FE model.
/// @param masters  [n_m] global DOFs of the masters of `system`
/// @note   Collective.
/// @throws chladni::Error for a loaded DOF that is no master.
std::vector<reduce::HarmonicLoads> full_response_loads(const scene::Scene& scene,
                                                       const mbs_export::ReducedSystem& system,
                                                       const std::vector<PetscInt>& masters);

}  // namespace chladni::cases
