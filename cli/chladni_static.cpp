#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/fe_solution.hpp"
#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "plate/assembly/loads.hpp"
#include "plate/assembly/recovery.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cli {
namespace {

using Eigen::MatrixXd;

/// What was found, on every rank.
struct Found {
  MatrixXd motions;                                ///< [n_nodes x 6] m, rad
  MatrixXd reactions;                              ///< [n_active x 6] N, N m on the body
  double work;                                     ///< J, of the loads: twice the strain energy
  std::vector<plate::ShellResultants> resultants;  ///< at the nodes, of each section
};

/// K u = f has no solution when a part of the body can move freely.
void check_supported(const scene::Scene& scene, const cases::SupportedModel& model)
{
  if (model.free.empty()) return;
  const plate::FreePart& part = model.free.front();
  throw Error(fmt::format(
      "{}: {} of {} nodes around ({:.4g}, {:.4g}, {:.4g}) m can move freely in {}; hold it with a "
      "[[support]] or connect it to the rest",
      scene.path, part.n_nodes == model.system.dofs.n_active() ? "the body" : "a part of the body",
      part.n_nodes, part.centre[0], part.centre[1], part.centre[2], describe_motions(part)));
}

void check_loads(const scene::Scene& scene)
{
  if (!scene.loads.empty()) return;
  throw Error(fmt::format("{}: load is missing: `chladni static` needs a [[load]]", scene.path));
}

Found solve(const scene::Scene& scene, const cases::SupportedModel& model,
            const linear::SolverOptions& solver)
{
  const petsc::Vector f = plate::load_vector(model.mesh, model.system, scene.loads);
  check_supported(scene, model);
  const reduce::StaticSolution solution = reduce::static_solution(
      model.system.K, f, reduce::free_dofs(model.system.K, model.held), solver);
  Found found;
  found.motions = plate::node_motions(model.system.dofs, solution.u);
  found.reactions = plate::reactions(model.system.dofs, model.held, solution.reaction);
  petsc::check(VecDot(f, solution.u, &found.work));
  for (const plate::ShellSection& section : scene.sections) {
    found.resultants.push_back(
        plate::nodal_resultants(model.mesh, section, found.motions, PETSC_COMM_WORLD));
  }
  return found;
}

report::TextTable solution_table(const Found& found)
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

/// Displacements of the nodes of the groups that the scene wants reported.
report::TextTable reported_table(const scene::Scene& scene, const cases::SupportedModel& model,
                                 const Found& found)
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

report::Json reported_json(const scene::Scene& scene, const cases::SupportedModel& model,
                           const Found& found)
{
  std::vector<report::Json::Member> groups;
  for (const std::string& name : scene.static_solution.value_or(scene::StaticOptions{}).report) {
    std::vector<report::Json> nodes;
    for (const int node : model.system.dofs.named_nodes(model.mesh, name)) {
      nodes.push_back(
          report::Json::object({{"node", cases::node_number(model.mesh, model.system.dofs, node)},
                                {"motion", numbers_json(found.motions.row(node).transpose())}}));
    }
    groups.emplace_back(name, report::Json::array(nodes));
  }
  return report::Json::object(groups);
}

std::vector<report::Json::Member> solution_json(const scene::Scene& scene,
                                                const cases::SupportedModel& model,
                                                const Found& found)
{
  std::vector<report::Json::Member> members = cases::model_json(model);
  const Eigen::VectorXd sum = found.reactions.colwise().sum().head<3>();
  members.emplace_back("largest_displacement_m",
                       found.motions.leftCols<3>().rowwise().norm().maxCoeff());
  members.emplace_back("reaction_N", numbers_json(sum));
  members.emplace_back("strain_energy_J", 0.5 * found.work);
  members.emplace_back("motions", reported_json(scene, model, found));
  return members;
}

report::VtuGrid picture(const scene::Scene& scene, const cases::SupportedModel& model,
                        const Found& found)
{
  report::SceneGrid grid = report::scene_grid(model.mesh, scene.sections, model.owners);
  report::add_motions(grid, found.motions, "");
  report::add_resultants(grid, model.mesh, scene.sections, found.resultants);
  return std::move(grid.grid);
}

}  // namespace

void static_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  check_loads(scene);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".static.vtu");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar =
      progress_bar({{"mesh", 10.0}, {"assembly", 20.0}, {"solution", 70.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  phases.begin("solution");
  const Found found = solve(scene, model, arguments.solver);
  phases.end();
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    const report::TextTable reported = reported_table(scene, model, found);
    files::write_text(
        file, report::vtu_text(picture(scene, model, found)) + writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}{}{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(solution_table(found)),
               reported.rows.empty() ? "" : report::format_table(reported),
               reported.rows.empty() ? "" : "\n", report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    write_summary(arguments.scene, solution_json(scene, model, found), cost);
  });
}

}  // namespace chladni::cli
