#include <fmt/format.h>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "report/describe.hpp"
#include "report/selection_json.hpp"

namespace chladni::cli {
namespace {

void write_both_files(const scene::Scene& scene, const SceneArguments& arguments,
                      const mbs_export::ReducedSystem& reduced, const mbs_export::ModalBody& body)
{
  report::make_folder(arguments.output);
  mbs_export::write_reduced(reduced_file(scene, arguments), reduced);
  mbs_export::write_body(body_file(scene, arguments), body);
}

void print_and_write_summary(const SceneArguments& arguments, const cases::ReduceSummary& summary,
                             const mbs_export::ModalBody& body, const report::Cost& cost)
{
  const std::string selection = report::describe_selection(body);
  fmt::print(
      "{}\n\n{}\n{}{}{}\n{}\n{}", body.title, report::format_table(report::list_modes(body)),
      selection, selection.empty() ? "" : "\n", report::format_table(reduction_table(summary)),
      report::format_table(report::describe(body)), report::format_table(report::cost_table(cost)));
  std::vector<report::Json::Member> members = reduction_json(summary);
  members.emplace_back("frequencies_Hz", frequencies_json(body.omega));
  members.emplace_back("n_rigid", body.n_rigid);
  for (report::Json::Member& member : report::preparation_json(body))
    members.push_back(std::move(member));
  write_summary(arguments, members, cost);
}

}  // namespace

void run_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = scene::read_meshed_scene(arguments.scene.scene);
  cases::ReduceSummary summary = reduce_with_progress(scene, arguments);
  // Both files are written at the end: a scene whose body cannot be made leaves none.
  report::PhaseClock clock;
  mbs_export::ModalBody body;
  cases::on_first_rank([&] { body = make_body_of(scene, summary.reduced); });
  clock.end_phase("body");
  cases::on_first_rank([&] { write_both_files(scene, arguments.scene, summary.reduced, body); });
  clock.end_phase("write");

  for (const report::PhaseTime& phase : clock.phases()) summary.phases.push_back(phase);
  summary.factorization = time_of_all_ranks(summary.factorization);
  const report::Cost cost = cost_of_all_ranks(summary.phases);
  cases::on_first_rank([&] {
    print_and_write_summary(arguments.scene, summary, body, cost);
    fmt::print("\nwrote {}\nwrote {}\n", reduced_file(scene, arguments.scene).string(),
               body_file(scene, arguments.scene).string());
  });
}

}  // namespace chladni::cli
