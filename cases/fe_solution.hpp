#pragma once

#include <vector>

#include "cases/reduce_steps.hpp"
#include "linear/solver_options.hpp"
#include "plate/dofs/free_motions.hpp"
#include "report/fe/vtu_scene.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

/// The steps that `chladni static` and `chladni modes` share.
namespace chladni::cases {

/// The FE model under the supports of the scene.
struct SupportedModel {
  mesh::Mesh mesh;
  plate::System system;
  std::vector<int> owners;            ///< [n_nodes of the mesh] rank of each node
  std::vector<int> held;              ///< DOFs, ascending
  std::vector<plate::FreePart> free;  ///< what can still move as a rigid body
};

/// The model of a mesh of the scene.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel assemble_supported(const scene::Scene& scene, mesh::Mesh mesh);

/// On a mesh that keeps the accuracy of the scene, if it asks for one. The phase of the assembly is
/// still under way at its end.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel supported_model(const scene::Scene& scene, const linear::SolverOptions& solver,
                               Phases& phases);

/// Table of what the model is like.
report::TextTable model_table(const SupportedModel& model);

/// Members `n_nodes`, `n_dofs`, `n_held`, `n_rigid`.
std::vector<report::Json::Member> model_json(const SupportedModel& model);

}  // namespace chladni::cases
