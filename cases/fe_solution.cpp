#include "cases/fe_solution.hpp"

#include <fmt/format.h>

#include "cases/chosen_mesh.hpp"
#include "cases/mesh_scene.hpp"
#include "cases/ranks.hpp"
#include "common/error.hpp"
#include "mesh/partition.hpp"
#include "plate/dofs/drilling.hpp"
#include "plate/dofs/supports.hpp"

namespace chladni::cases {

SupportedModel assemble_supported(const scene::Scene& scene, mesh::Mesh mesh)
{
  if (mesh.sectors.count > 1) {
    throw Error(
        "sectors: `static`, `modes` and responses of the FE model need the mesh of the whole body, "
        "and this one is a sector; take mesh.sectors out and mesh all of it");
  }
  std::vector<int> owners = mesh::node_owners(mesh, n_ranks());
  plate::DofMap dofs = plate::make_dof_map(
      mesh, {.couplings = scene.couplings, .components = scene.components}, owners, n_ranks());
  plate::check_stiffness_of_all_nodes(mesh, dofs);
  std::vector<int> held = plate::held_dofs(mesh, dofs, scene.supports);
  plate::refuse_drilling(mesh, dofs, scene.supports, scene.springs);
  std::vector<plate::FreePart> free = plate::free_parts(mesh, dofs, held, scene.springs);
  plate::System system =
      plate::assemble(mesh, structure_of(scene), std::move(dofs), PETSC_COMM_WORLD);
  return {.mesh = std::move(mesh),
          .system = std::move(system),
          .owners = std::move(owners),
          .held = std::move(held),
          .free = std::move(free)};
}

SupportedModel supported_model(const scene::Scene& scene, const linear::SolverOptions& solver,
                               Phases& phases)
{
  const scene::Scene meshed =
      scene.accuracy ? chosen_mesh(scene, scene.supports, solver, phases).scene : scene;
  phases.begin("mesh");
  mesh::Mesh mesh = mesh_on_all_ranks(meshed);
  phases.begin("assembly");
  return assemble_supported(meshed, std::move(mesh));
}

report::TextTable model_table(const SupportedModel& model)
{
  report::TextTable table{.header = {"model", "value"}, .rows = {}};
  table.rows.push_back({"nodes of the mesh", fmt::format("{}", model.mesh.n_nodes())});
  table.rows.push_back({"DOFs", fmt::format("{}", model.system.dofs.n_dofs())});
  table.rows.push_back({"DOFs held by supports", fmt::format("{}", model.held.size())});
  return table;
}

std::vector<report::Json::Member> model_json(const SupportedModel& model)
{
  return {{"n_nodes", model.mesh.n_nodes()},
          {"n_dofs", model.system.dofs.n_dofs()},
          {"n_held", model.held.size()},
          {"n_rigid", plate::n_free_motions(model.free)}};
}

}  // namespace chladni::cases
