#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/fe_solution.hpp"
#include "cases/mesh_errors.hpp"
#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "files/text_file.hpp"
#include "plate/assembly/recovery.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cli {
namespace {

/// rad/s; rigid-body motions have none, whatever round-off says.
Eigen::VectorXd angular_frequencies(const std::vector<double>& lambda, int n_rigid)
{
  Eigen::VectorXd omega = Eigen::VectorXd::Zero(std::ssize(lambda));
  for (Eigen::Index i = n_rigid; i < omega.size(); ++i)
    omega[i] = std::sqrt(std::max(lambda[static_cast<std::size_t>(i)], 0.0));
  return omega;
}

/// @param errors  [elastic modes] of the mesh, or none
report::TextTable mode_table(const Eigen::VectorXd& omega, int n_rigid,
                             const Eigen::VectorXd& errors)
{
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

/// The picture of all modes, on the first rank; each is scaled to a largest displacement of 1.
report::SceneGrid mode_grid(const scene::Scene& scene, const cases::SupportedModel& model,
                            const reduce::NaturalModes& modes)
{
  report::SceneGrid grid;
  cases::on_first_rank(
      [&] { grid = report::scene_grid(model.mesh, scene.sections, model.owners); });
  for (PetscInt j = 0; j < std::ssize(modes.lambda); ++j) {
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecRead(modes.X, j, &column));
    Eigen::MatrixXd motions = plate::node_motions(model.system.dofs, column);
    petsc::check(MatDenseRestoreColumnVecRead(modes.X, j, &column));
    const double largest = motions.leftCols<3>().rowwise().norm().maxCoeff();
    if (largest > 0.0) motions /= largest;
    cases::on_first_rank(
        [&] { report::add_motions(grid, motions, fmt::format("mode {:03d} ", j + 1)); });
  }
  return grid;
}

}  // namespace

void modes_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".modes.vtu");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar = progress_bar({{"mesh", 10.0}, {"assembly", 20.0}, {"modes", 70.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  const int n_rigid = plate::n_free_motions(model.free);
  const scene::ModesOptions asked = scene.natural_modes.value_or(scene::ModesOptions{});
  phases.begin("modes");
  const reduce::NaturalModes modes = reduce::natural_modes(
      model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
      {.n_modes = asked.count, .n_rigid = n_rigid, .solver = arguments.solver});
  Eigen::VectorXd errors;
  if (asked.mesh_errors) {
    phases.begin("errors of the mesh");
    errors = cases::mesh_errors(scene, model, modes, arguments.solver).errors;
  }
  phases.end();
  const Eigen::VectorXd omega = angular_frequencies(modes.lambda, n_rigid);
  const report::SceneGrid grid = mode_grid(scene, model, modes);
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    files::write_text(file, report::vtu_text(grid.grid) + writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(mode_table(omega, n_rigid, errors)),
               report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    std::vector<report::Json::Member> members = cases::model_json(model);
    members.emplace_back("n_modes", omega.size());
    members.emplace_back("frequencies_Hz", frequencies_json(omega));
    if (errors.size() > 0) members.emplace_back("errors_of_mesh", numbers_json(errors));
    write_summary(arguments.scene, members, cost);
  });
}

}  // namespace chladni::cli
