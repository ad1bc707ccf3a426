#include "cases/chosen_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cases/mesh_frequencies.hpp"
#include "cases/mesh_scene.hpp"
#include "cases/mesh_search.hpp"
#include "cases/ranks.hpp"
#include "cases/size_of_mesh.hpp"
#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "plate/dofs/dof_map.hpp"
#include "report/progress.hpp"

namespace chladni::cases {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

void refuse_sectors(const scene::Scene& scene)
{
  const int sectors = scene.mesh.annulus    ? scene.mesh.annulus->sectors
                      : scene.mesh.hat_disc ? scene.mesh.hat_disc->sectors
                                            : scene.mesh.sectors;
  if (sectors > 1) {
    scene::refuse_key(scene, "mesh.sectors",
                      "the error of the mesh is estimated on the whole body; take this key out, or "
                      "write sectors = \"auto\"");
  }
}

/// The errors on the mesh of the scene as it is.
MeshErrors errors_of(const scene::Scene& scene, double up_to_Hz,
                     const linear::SolverOptions& solver)
{
  return MeshFrequencies(scene, mesh_on_all_ranks(scene)).errors_up_to(two_pi * up_to_Hz, solver);
}

/// Of what the scene's body wants to be right.
double range_of(const scene::Scene& scene)
{
  if (scene.accuracy) return scene.accuracy->up_to_Hz;
  if (scene.reduce.tolerance) return scene.reduce.tolerance->up_to_Hz;
  if (scene.body.keep.tolerance) return scene.body.keep.tolerance->up_to_Hz;
  if (scene.body.keep.up_to_Hz) return *scene.body.keep.up_to_Hz;
  if (scene.reduce.cutoff_Hz) return *scene.reduce.cutoff_Hz;
  scene::refuse_key(
      scene, "reduce.mesh_errors",
      "up to which frequency? give reduce.tolerance or body.keep with up_to_Hz, or cutoff_Hz");
}

MeshChoice own_mesh(const scene::Scene& supported, const scene::Scene& scene,
                    const linear::SolverOptions& solver)
{
  MeshChoice choice{.scene = scene, .errors = errors_of(supported, range_of(scene), solver)};
  if (scene.accuracy && choice.errors->largest() > share_of_mesh * scene.accuracy->error) {
    const double error = choice.errors->largest();
    const auto [reached, allowed] = told_apart(error, share_of_mesh * scene.accuracy->error);
    throw Error(fmt::format(
        "{}: accuracy.error = {:.6g}: the mesh may have {} of it, and that of {} has an error of "
        "{} up to {:.6g} Hz; its size cannot be chosen: give a finer one, or ask for {:.2g}",
        scene.path, scene.accuracy->error, allowed, *scene.mesh.file, reached,
        scene.accuracy->up_to_Hz, possible_error(error)));
  }
  return choice;
}

}  // namespace

std::vector<plate::Support> supports_of(const scene::Scene& scene)
{
  std::vector<plate::Support> supports;
  const std::vector<std::string>& sets = scene.interface_nodes;
  for (const std::string& name : scene.body.fixed) {
    const bool is_set = std::ranges::find(sets, name) != sets.end();  // it may have a dot
    const std::size_t dot = is_set ? std::string::npos : name.rfind('.');
    const std::string component = dot == std::string::npos ? "" : name.substr(dot + 1);
    const auto known = std::ranges::find(plate::component_names, component);
    if (known == plate::component_names.end()) {
      supports.push_back({.group = name, .components = {0, 1, 2, 3, 4, 5}});
    } else {
      const auto c = static_cast<int>(known - plate::component_names.begin());
      supports.push_back({.group = name.substr(0, dot), .components = {c}});
    }
  }
  return supports;
}

MeshChoice chosen_mesh(const scene::Scene& scene, const std::vector<plate::Support>& supports,
                       const linear::SolverOptions& solver, Phases& phases)
{
  if (!scene.accuracy && !scene.mesh_errors) return {.scene = scene, .errors = {}};
  refuse_sectors(scene);
  phases.begin("errors of the mesh");
  scene::Scene supported = scene;
  supported.supports = supports;
  if (!scene.accuracy || !has_size(scene.mesh)) return own_mesh(supported, scene, solver);
  FoundMesh found = search_mesh(supported, solver);
  MeshChoice choice{.scene = scene, .errors = std::move(found.errors)};
  set_size(choice.scene.mesh, found.size);
  on_first_rank([&] {
    report::tell_note(
        fmt::format("accuracy {:.1e} up to {:.6g} Hz: {}; estimated error of the mesh {:.1e}",
                    scene.accuracy->error, scene.accuracy->up_to_Hz, described(found.size),
                    choice.errors->largest()));
  });
  return choice;
}

}  // namespace chladni::cases
