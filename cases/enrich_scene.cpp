#include "cases/enrich_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/error.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/drilling.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::cases {
namespace {

using mbs_export::InterfaceModes, mbs_export::ReducedSystem;

/// Rows of K_r that are loaded, for each omega0 in rad/s.
using Loads = std::map<double, std::set<int>>;

/// Half the first elastic free frequency; the same on every rank.
double automatic_omega0(const ReducedSystem& system)
{
  const mbs_export::FreeModes free = mbs_export::orthogonalize(system);
  double omega0 = free.n_rigid < free.omega.size() ? 0.5 * free.omega[free.n_rigid] : 0.0;
  MPI_Bcast(&omega0, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return omega0;
}

/// The loads of a ring of harmonics: its harmonics along or about its axis.
void add_axial_harmonics(const ReducedSystem& system, int set, int component, std::set<int>& rows)
{
  for (std::size_t row = 0; row < system.masters.size(); ++row) {
    const mbs_export::MasterDof& dof = system.masters[row];
    if (dof.harmonic && dof.harmonic->set == set && dof.component == component)
      rows.insert(static_cast<int>(row));
  }
}

/// Rows of K_r of one component of the loaded set.
void add_loads(const ReducedSystem& system, const InterfaceModes& wanted, int component,
               std::set<int>& rows)
{
  const mbs_export::AttachmentSet& set = mbs_export::find_set(system, wanted.at);
  const char* name = mbs_export::component_name(component);
  const auto index = static_cast<int>(&set - system.sets.data());
  const bool is_ring = std::ranges::any_of(
      system.masters, [&](const auto& dof) { return dof.harmonic && dof.harmonic->set == index; });
  for (const int node : set.nodes) mbs_export::refuse_drilling_load(system, node, component);
  if (is_ring && component % 3 == 2) return add_axial_harmonics(system, index, component, rows);
  for (const int node : set.nodes) {
    if (const auto row = mbs_export::master_row(system, node, component))
      rows.insert(*row);
    else if (mbs_export::has_component(system, node, component))
      throw Error(
          fmt::format("interface_modes at \"{}\": with space = \"full\", nodes of a ring of "
                      "harmonics are loaded "
                      "along z and rz only, not along {}; use space = \"reduced\"",
                      wanted.at, name));
    else
      throw Error(fmt::format("interface_modes at \"{}\": component {} is no DOF of the model",
                              wanted.at, name));
  }
}

Loads loads_of(const scene::Scene& scene, const ReducedSystem& system)
{
  const mbs_export::HeldDofs held = mbs_export::held_dofs(system, scene.body.fixed);
  if (!held.are_masters()) {
    throw Error(
        "interface_modes: with space = \"full\" nodes of a ring of harmonics cannot be held; use "
        "space = \"reduced\"");
  }
  Loads loads;
  for (const InterfaceModes& wanted : scene.body.interface_modes) {
    if (wanted.space != InterfaceModes::Space::full) continue;
    std::set<int>& rows = loads[wanted.omega0 ? *wanted.omega0 : automatic_omega0(system)];
    rows.insert(held.rows.begin(), held.rows.end());
    for (const int component : wanted.components) add_loads(system, wanted, component, rows);
  }
  return loads;
}

}  // namespace

bool wants_full_responses(const scene::Scene& scene)
{
  return std::ranges::any_of(scene.body.interface_modes, [](const InterfaceModes& wanted) {
    return wanted.space == InterfaceModes::Space::full;
  });
}

std::vector<reduce::HarmonicLoads> full_response_loads(const scene::Scene& scene,
                                                       const ReducedSystem& system,
                                                       const std::vector<PetscInt>& masters)
{
  std::vector<reduce::HarmonicLoads> loads;
  for (const auto& [omega0, rows] : loads_of(scene, system)) {
    loads.push_back({.Omega_0 = omega0, .loaded = {}});
    for (const int row : rows)
      loads.back().loaded.push_back(masters[static_cast<std::size_t>(row)]);
  }
  return loads;
}

}  // namespace chladni::cases
