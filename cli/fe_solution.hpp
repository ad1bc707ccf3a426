#pragma once

#include <vector>

#include "cli/chladni_steps.hpp"
#include "cli/reduce_steps.hpp"
#include "cli/vtu_scene.hpp"
#include "plate/free_motions.hpp"

/// The steps that `chladni static` and `chladni modes` share.
namespace chladni::cli {

/// The FE model under the supports of the scene.
struct SupportedModel {
  mesh::Mesh mesh;
  plate::System system;
  std::vector<int> owners;            ///< [n_nodes of the mesh] rank of each node
  std::vector<int> held;              ///< DOFs, ascending
  std::vector<plate::FreePart> free;  ///< what can still move as a rigid body
};

/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel supported_model(const Scene& scene, Phases& phases);

/// Table of what the model is like.
TextTable model_table(const SupportedModel& model);

/// Members `n_nodes`, `n_dofs`, `n_held`, `n_rigid`.
std::vector<Json::Member> model_json(const SupportedModel& model);

}  // namespace chladni::cli
