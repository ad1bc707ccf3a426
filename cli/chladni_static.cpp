#include <fmt/format.h>

#include "cases/fe_solution.hpp"
#include "cases/ranks.hpp"
#include "cases/static_fields.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/writer_mark.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"

namespace chladni::cli {
namespace {

void check_loads(const scene::Scene& scene)
{
  if (!scene.loads.empty()) return;
  throw Error(fmt::format("{}: load is missing: `chladni static` needs a [[load]]", scene.path));
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
  const cases::StaticFields found = cases::static_fields(scene, model, arguments.solver);
  phases.end();
  bar = {};
  const report::Cost cost = cost_of_all_ranks(phases.times());
  cases::on_first_rank([&] {
    const report::TextTable reported = cases::reported_table(scene, model, found);
    files::write_text(file, report::vtu_text(cases::static_picture(scene, model, found)) +
                                writer_mark(arguments.scene));
    fmt::print("{}\n\n{}\n{}{}{}\n{}\nwrote {}\n", report::printable(scene.title),
               report::format_table(cases::static_table(found)),
               reported.rows.empty() ? "" : report::format_table(reported),
               reported.rows.empty() ? "" : "\n", report::format_table(cases::model_table(model)),
               report::format_table(report::cost_table(cost)), file.string());
    write_summary(arguments.scene, cases::static_json(scene, model, found), cost);
  });
}

}  // namespace chladni::cli
