#include <fmt/format.h>

#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/describe.hpp"
#include "cli/petsc_session.hpp"
#include "cli/selection_json.hpp"
#include "common/error.hpp"
#include "mbs_export/body_file.hpp"
#include "mbs_export/reduced_file.hpp"

namespace chladni::cli {
namespace {

mbs_export::ReducedSystem read_reduced_of(const Scene& scene, const SceneArguments& arguments)
{
  const std::filesystem::path file = reduced_file(scene, arguments);
  if (!std::filesystem::exists(file)) {
    throw Error(fmt::format("{}: no such file; make it with `chladni reduce {} --output {}`",
                            file.string(), arguments.scene, arguments.output));
  }
  return mbs_export::read_reduced(file);
}

void make_and_write_body(const SceneArguments& arguments)
{
  PhaseClock clock;
  const Scene scene = read_meshed_scene(arguments.scene);
  const mbs_export::ReducedSystem reduced = read_reduced_of(scene, arguments);
  clock.end_phase("read");
  const mbs_export::ModalBody body = make_body_of(scene, reduced);
  clock.end_phase("body");
  const std::filesystem::path file = body_file(scene, arguments);
  mbs_export::write_body(file, body);
  clock.end_phase("write");

  const Cost cost = cost_so_far(clock.phases());
  const std::string selection = describe_selection(body);
  fmt::print("{}\n\n{}\n{}{}{}\n{}\nwrote {}\n", scene.title, format_table(list_modes(body)),
             selection, selection.empty() ? "" : "\n", format_table(describe(body)),
             format_table(cost_table(cost)), file.string());
  std::vector<Json::Member> members = {{"n_masters", reduced.n_masters()},
                                       {"n_modes", reduced.fixed_interface_frequencies.size()},
                                       {"frequencies_Hz", frequencies_json(body.omega)},
                                       {"n_rigid", body.n_rigid}};
  for (Json::Member& member : preparation_json(body)) members.push_back(std::move(member));
  write_summary(arguments, members, cost);
}

}  // namespace

void body_command(const ChladniArguments& arguments)
{
  on_first_rank([&] { make_and_write_body(arguments.scene); });
}

}  // namespace chladni::cli
