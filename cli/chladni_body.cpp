#include <fmt/format.h>
#include "report/numbers_json.hpp"

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "report/describe.hpp"
#include "report/origin.hpp"
#include "report/selection_json.hpp"

namespace chladni::cli {
namespace {

void make_and_write_body(const SceneArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = scene::read_meshed_scene(arguments.scene);
  tell_notes(scene);
  const std::filesystem::path file = body_file(scene, arguments);
  const mbs_export::ReducedSystem reduced = read_reduced_of(scene, arguments);
  const ReservedOutputs reserved = reserve_outputs(arguments, {file});
  clock.end_phase("read");
  const mbs_export::ModalBody body = make_body_of(scene, reduced);
  clock.end_phase("body");
  mbs_export::write_body(file, body);
  clock.end_phase("write");

  const report::Cost cost = report::cost_so_far(clock.phases());
  const std::string selection = report::describe_selection(body);
  fmt::print("{}\n\n{}\n{}{}{}\n{}\nwrote {}\n", report::printable(scene.title),
             report::format_table(report::list_modes(body)), selection,
             selection.empty() ? "" : "\n", report::format_table(report::describe(body)),
             report::format_table(report::cost_table(cost)), file.string());
  std::vector<report::Json::Member> members = {
      {"n_masters", reduced.n_masters()},
      {"n_modes", reduced.fixed_interface_frequencies.size()},
      {"frequencies_Hz", report::frequencies_json(body.omega)},
      {"n_rigid", body.n_rigid}};
  for (report::Json::Member& member : report::preparation_json(body))
    members.push_back(std::move(member));
  write_summary(arguments, members, cost);
}

}  // namespace

void body_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { make_and_write_body(arguments.scene); });
}

}  // namespace chladni::cli
