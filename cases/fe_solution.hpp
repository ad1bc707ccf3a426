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
  std::vector<plate::FreePart> free;  ///< parts that can still move as rigid bodies
};

/// Assembles the FE model of a scene on a given mesh.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel assemble_supported(const scene::Scene& scene, mesh::Mesh mesh);

/// Assembles the FE model of a scene on its mesh, or, if it asks for an accuracy, on a mesh that
/// keeps it. The phase of the assembly is still open when it returns.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel supported_model(const scene::Scene& scene, const linear::SolverOptions& solver,
                               Phases& phases);

/// A table of the sizes of the model.
report::TextTable model_table(const SupportedModel& model);

/// The JSON members `n_nodes`, `n_dofs`, `n_held`, `n_rigid`.
std::vector<report::Json::Member> model_json(const SupportedModel& model);

}  // namespace chladni::cases
