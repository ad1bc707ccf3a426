#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/fe_solution.hpp"
#include "cli/petsc_session.hpp"
#include "plate/recovery.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cli {
namespace {

/// rad/s; rigid-body motions have none, whatever round-off says.
Eigen::VectorXd angular_frequencies(const std::vector<double>& lambda, int n_rigid)
{
  Eigen::VectorXd omega = Eigen::VectorXd::Zero(std::ssize(lambda));
  for (Eigen::Index i = n_rigid; i < omega.size(); ++i) {
    omega[i] = std::sqrt(std::max(lambda[static_cast<std::size_t>(i)], 0.0));
  }
  return omega;
}

TextTable mode_table(const Eigen::VectorXd& omega, int n_rigid)
{
  TextTable table{.header = {"mode", "frequency, Hz", "kind"}, .rows = {}};
  for (Eigen::Index i = 0; i < omega.size(); ++i) {
    table.rows.push_back({fmt::format("{}", i + 1),
                          fmt::format("{:.6f}", omega[i] / (2.0 * std::numbers::pi)),
                          i < n_rigid ? "rigid" : "elastic"});
  }
  return table;
}

/// The picture of all modes, on the first rank; each is scaled to a largest displacement of 1.
SceneGrid mode_grid(const Scene& scene, const SupportedModel& model,
                    const reduce::NaturalModes& modes)
{
  SceneGrid grid;
  on_first_rank([&] { grid = scene_grid(model.mesh, scene.sections, model.owners); });
  for (PetscInt j = 0; j < std::ssize(modes.lambda); ++j) {
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecRead(modes.X, j, &column));
    Eigen::MatrixXd motions = plate::node_motions(model.system.dofs, column);
    petsc::check(MatDenseRestoreColumnVecRead(modes.X, j, &column));
    const double largest = motions.leftCols<3>().rowwise().norm().maxCoeff();
    if (largest > 0.0) motions /= largest;
    on_first_rank([&] { add_motions(grid, motions, fmt::format("mode {:03d} ", j + 1)); });
  }
  return grid;
}

}  // namespace

void modes_command(const ChladniArguments& arguments)
{
  const Scene scene = read_meshed_scene(arguments.scene.scene, Purpose::fe_model);
  const ReduceProgress silent;
  Phases phases(silent);
  const SupportedModel model = supported_model(scene, phases);
  const int n_rigid = plate::n_free_motions(model.free);
  const int n_modes = scene.natural_modes.value_or(ModesOptions{}).count;
  const reduce::NaturalModes modes = phases.run("modes", [&] {
    return reduce::natural_modes(
        model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
        {.n_modes = n_modes, .n_rigid = n_rigid, .solver = arguments.solver});
  });
  const Eigen::VectorXd omega = angular_frequencies(modes.lambda, n_rigid);
  const SceneGrid grid = mode_grid(scene, model, modes);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".modes.vtu");
  const Cost cost = cost_of_all_ranks(phases.times());
  on_first_rank([&] {
    make_folder(arguments.scene.output);
    write_text_atomically(file, vtu_text(grid.grid));
    fmt::print("{}\n\n{}\n{}\n{}\nwrote {}\n", scene.title,
               format_table(mode_table(omega, n_rigid)), format_table(model_table(model)),
               format_table(cost_table(cost)), file.string());
    std::vector<Json::Member> members = model_json(model);
    members.emplace_back("n_modes", omega.size());
    members.emplace_back("frequencies_Hz", frequencies_json(omega));
    write_summary(arguments.scene, members, cost);
  });
}

}  // namespace chladni::cli
