#include "cases/static_fields.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "plate/assembly/loads.hpp"
#include "reduce/supported_solutions.hpp"
#include "report/fe/vtu_scene.hpp"
#include "report/numbers_json.hpp"

namespace chladni::cases {
namespace {

/// K u = f has no solution when a part of the body can move freely.
void check_supported(const scene::Scene& scene, const SupportedModel& model)
{
  if (model.free.empty()) return;
  const plate::FreePart& part = model.free.front();
  throw Error(fmt::format(
      "{}: {} of {} nodes around ({:.4g}, {:.4g}, {:.4g}) m can move freely in {}; hold it with a "
      "[[support]] or connect it to the rest",
      scene.path, part.n_nodes == model.system.dofs.n_active() ? "the body" : "a part of the body",
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
  return found;
}

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
  members.emplace_back("motions", reported_json(scene, model, found));
  return members;
}

report::VtuGrid static_picture(const scene::Scene& scene, const SupportedModel& model,
                               const StaticFields& found)
{
  report::SceneGrid grid = report::scene_grid(model.mesh, scene.sections, model.owners);
  report::add_motions(grid, found.motions, "");
  report::add_resultants(grid, model.mesh, scene.sections, found.resultants);
  return std::move(grid.grid);
}

}  // namespace chladni::cases
