#include <fmt/format.h>

#include <filesystem>

#include "cases/ranks.hpp"
#include "cases/scene_modes.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "files/text_file.hpp"

namespace chladni::cli {

void modes_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments, scene::Purpose::fe_model);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".modes.vtu");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar = progress_bar({{"mesh", 10.0}, {"assembly", 20.0}, {"modes", 70.0}});
  cases::Phases phases(bar);
  const cases::SupportedModel model = cases::supported_model(scene, arguments.solver, phases);
  const cases::SceneModes found = cases::scene_modes(scene, model, arguments.solver, phases);
  const report::SceneGrid grid = cases::mode_grid(scene, model, found.modes);
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    files::write_text(file, report::vtu_text(grid.grid) + writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(cases::mode_table(found)),
               report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    write_summary(arguments.scene, cases::modes_json(model, found), cost);
  });
}

}  // namespace chladni::cli
