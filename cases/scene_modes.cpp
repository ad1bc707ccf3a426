#include "cases/scene_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cases/mesh_errors.hpp"
#include "cases/ranks.hpp"
#include "plate/assembly/recovery.hpp"
#include "report/numbers_json.hpp"

namespace chladni::cases {
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
