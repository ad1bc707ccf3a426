#include "cases/fe_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "cases/chosen_mesh.hpp"
#include "cases/mesh_errors.hpp"
#include "cases/ranks.hpp"
#include "cases/scene_mesh.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/drilling.hpp"
#include "plate/elements/solid_element.hpp"
#include "reduce/supported_solutions.hpp"
#include "report/fe/vtu.hpp"
#include "report/json.hpp"

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
  if (scene.accuracy) expect_mass(scene);
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

namespace {

/// K u = f has no solution when a part of the body can move freely.
void check_supported(const scene::Scene& scene, const SupportedModel& model)
{
  if (model.free.empty()) return;
  const plate::FreePart& part = model.free.front();
  throw Error(fmt::format(
      "{}: {} of {} nodes around ({:.4g}, {:.4g}, {:.4g}) m can move freely in {}; hold it with a "
      "[[support]] or connect it to the rest",
      scene.path,
      part.n_nodes == model.system.dofs.n_independent() ? "the body" : "a part of the body",
      part.n_nodes, part.centre[0], part.centre[1], part.centre[2], describe_motions(part)));
}

report::Json reported_json(const scene::Scene& scene, const SupportedModel& model,
                           const StaticFields& found)
{
  std::vector<report::Json::Member> groups;
  for (const std::string& name : scene.static_solution.value_or(scene::StaticOptions{}).report) {
    std::vector<report::Json> nodes;
    for (const int node : model.system.dofs.named_nodes(model.mesh, name)) {
      nodes.push_back(report::Json::object(
          {{"node", node_number(model.mesh, model.system.dofs, node)},
           {"motion", report::numbers_json(found.motions.row(node).transpose())}}));
      if (node >= model.mesh.n_nodes()) continue;
      for (const Eigen::MatrixXd& stresses : found.stresses) {
        if (stresses.row(node).isZero(0.0)) continue;  // another group has the node
        nodes.back() = report::Json::object(
            {{"node", node_number(model.mesh, model.system.dofs, node)},
             {"motion", report::numbers_json(found.motions.row(node).transpose())},
             {"stress_Pa", report::numbers_json(stresses.row(node).transpose())}});
        break;
      }
    }
    groups.emplace_back(name, report::Json::array(nodes));
  }
  return report::Json::object(groups);
}

}  // namespace

StaticFields static_fields(const scene::Scene& scene, const SupportedModel& model,
                           const linear::SolverOptions& solver)
{
  const petsc::Vector f = plate::load_vector(model.mesh, model.system, scene.loads);
  check_supported(scene, model);
  const reduce::StaticSolution solution = reduce::static_solution(
      model.system.K, f, reduce::free_dofs(model.system.K, model.held), solver);
  StaticFields found;
  found.motions = plate::node_motions(model.system.dofs, solution.u);
  found.reactions = plate::reactions(model.system.dofs, model.held, solution.reaction);
  petsc::check(VecDot(f, solution.u, &found.work));
  for (const plate::ShellSection& section : scene.sections) {
    found.resultants.push_back(
        plate::nodal_resultants(model.mesh, section, found.motions, PETSC_COMM_WORLD));
  }
  for (const plate::SolidSection& section : scene.solids) {
    found.stresses.push_back(
        plate::nodal_stresses(model.mesh, section, found.motions, PETSC_COMM_WORLD));
  }
  return found;
}

namespace {

/// Pa, at the nodes of solids.
double largest_von_mises(const StaticFields& found)
{
  double largest = 0.0;
  for (const Eigen::MatrixXd& stresses : found.stresses)
    largest = std::max(largest, plate::von_mises(stresses).maxCoeff());
  return largest;
}

}  // namespace

report::TextTable static_table(const StaticFields& found)
{
  report::TextTable table{.header = {"solution", "value"}, .rows = {}};
  table.rows.push_back(
      {"largest displacement, m",
       fmt::format("{:.6e}", found.motions.leftCols<3>().rowwise().norm().maxCoeff())});
  const Eigen::RowVectorXd sum = found.reactions.colwise().sum();
  table.rows.push_back(
      {"sum of the reactions, N", fmt::format("{:.6g} {:.6g} {:.6g}", sum[0], sum[1], sum[2])});
  table.rows.push_back({"strain energy, J", fmt::format("{:.6e}", 0.5 * found.work)});
  if (!found.stresses.empty()) {
    table.rows.push_back({"largest von Mises stress at a node, Pa",
                          fmt::format("{:.6e}", largest_von_mises(found))});
  }
  return table;
}

report::TextTable reported_table(const scene::Scene& scene, const SupportedModel& model,
                                 const StaticFields& found)
{
  report::TextTable table{.header = {"mean displacement of", "x, m", "y, m", "z, m"}, .rows = {}};
  for (const std::string& name : scene.static_solution.value_or(scene::StaticOptions{}).report) {
    const std::vector<int> nodes = model.system.dofs.named_nodes(model.mesh, name);
    const Eigen::RowVectorXd mean = found.motions(nodes, every).colwise().mean();
    table.rows.push_back({name, fmt::format("{:.6e}", mean[0]), fmt::format("{:.6e}", mean[1]),
                          fmt::format("{:.6e}", mean[2])});
  }
  return table;
}

std::vector<report::Json::Member> static_json(const scene::Scene& scene,
                                              const SupportedModel& model,
                                              const StaticFields& found)
{
  std::vector<report::Json::Member> members = model_json(model);
  const Eigen::VectorXd sum = found.reactions.colwise().sum().head<3>();
  members.emplace_back("largest_displacement_m",
                       found.motions.leftCols<3>().rowwise().norm().maxCoeff());
  members.emplace_back("reaction_N", report::numbers_json(sum));
  members.emplace_back("strain_energy_J", 0.5 * found.work);
  if (!found.stresses.empty())
    members.emplace_back("largest_von_mises_Pa", largest_von_mises(found));
  members.emplace_back("motions", reported_json(scene, model, found));
  return members;
}

report::VtuGrid static_picture(const scene::Scene& scene, const SupportedModel& model,
                               const StaticFields& found)
{
  report::SceneGrid grid = report::scene_grid(model.mesh, scene.sections, model.owners);
  report::add_motions(grid, found.motions, "");
  report::add_resultants(grid, model.mesh, scene.sections, found.resultants);
  report::add_stresses(grid, model.mesh, scene.solids, found.stresses);
  return std::move(grid.grid);
}

namespace {

Eigen::VectorXd angular_frequencies(const std::vector<double>& lambda, int n_rigid)
{
  Eigen::VectorXd omega = Eigen::VectorXd::Zero(std::ssize(lambda));
  for (Eigen::Index i = n_rigid; i < omega.size(); ++i)
    omega[i] = std::sqrt(std::max(lambda[static_cast<std::size_t>(i)], 0.0));
  return omega;
}

}  // namespace

SceneModes scene_modes(const scene::Scene& scene, const SupportedModel& model,
                       const linear::SolverOptions& solver, Phases& phases)
{
  expect_mass(scene);
  const scene::ModesOptions asked = scene.natural_modes.value_or(scene::ModesOptions{});
  const int n_rigid = plate::n_free_motions(model.free);
  phases.begin("modes");
  SceneModes found{
      .modes = reduce::natural_modes(
          model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
          {.n_modes = asked.count, .n_rigid = n_rigid, .solver = solver}),
      .n_rigid = n_rigid,
      .omega = {},
      .mesh_errors = {}};
  if (asked.mesh_errors) {
    phases.begin("errors of the mesh");
    found.mesh_errors = mesh_errors(scene, model, found.modes, solver).errors;
  }
  phases.end();
  found.omega = angular_frequencies(found.modes.lambda, n_rigid);
  return found;
}

report::TextTable mode_table(const SceneModes& found)
{
  const Eigen::VectorXd &omega = found.omega, &errors = found.mesh_errors;
  const int n_rigid = found.n_rigid;
  report::TextTable table{.header = {"mode", "frequency, Hz", "kind"}, .rows = {}};
  if (errors.size() > 0) table.header.emplace_back("error of the mesh");
  for (Eigen::Index i = 0; i < omega.size(); ++i) {
    table.rows.push_back({fmt::format("{}", i + 1),
                          fmt::format("{:.6f}", omega[i] / (2.0 * std::numbers::pi)),
                          i < n_rigid ? "rigid" : "elastic"});
    if (errors.size() > 0)
      table.rows.back().push_back(i < n_rigid ? "" : fmt::format("{:.1e}", errors[i - n_rigid]));
  }
  return table;
}

std::vector<report::Json::Member> modes_json(const SupportedModel& model, const SceneModes& found)
{
  std::vector<report::Json::Member> members = model_json(model);
  members.emplace_back("n_modes", found.omega.size());
  members.emplace_back("frequencies_Hz", report::frequencies_json(found.omega));
  if (found.mesh_errors.size() > 0)
    members.emplace_back("errors_of_mesh", report::numbers_json(found.mesh_errors));
  return members;
}

report::SceneGrid mode_grid(const scene::Scene& scene, const SupportedModel& model,
                            const reduce::NaturalModes& modes)
{
  report::SceneGrid grid;
  on_first_rank([&] { grid = report::scene_grid(model.mesh, scene.sections, model.owners); });
  for (PetscInt j = 0; j < std::ssize(modes.lambda); ++j) {
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecRead(modes.X, j, &column));
    Eigen::MatrixXd motions = plate::node_motions(model.system.dofs, column);
    petsc::check(MatDenseRestoreColumnVecRead(modes.X, j, &column));
    const double largest = motions.leftCols<3>().rowwise().norm().maxCoeff();
    if (largest > 0.0) motions /= largest;
    on_first_rank([&] { report::add_motions(grid, motions, fmt::format("mode {:03d} ", j + 1)); });
  }
  return grid;
}

}  // namespace chladni::cases
