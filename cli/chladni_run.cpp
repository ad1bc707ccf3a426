#include <fmt/format.h>

#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/describe.hpp"
#include "cli/petsc_session.hpp"
#include "cli/selection_json.hpp"
#include "mbs_export/body_file.hpp"
#include "mbs_export/reduced_file.hpp"

namespace chladni::cli {
namespace {

void write_both_files(const Scene& scene, const SceneArguments& arguments,
                      const mbs_export::ReducedSystem& reduced, const mbs_export::ModalBody& body)
{
  make_folder(arguments.output);
  mbs_export::write_reduced(reduced_file(scene, arguments), reduced);
  mbs_export::write_body(body_file(scene, arguments), body);
}

void print_and_write_summary(const SceneArguments& arguments, const ReduceSummary& summary,
                             const mbs_export::ModalBody& body, const Cost& cost)
{
  const std::string selection = describe_selection(body);
  fmt::print("{}\n\n{}\n{}{}{}\n{}\n{}", body.title, format_table(list_modes(body)), selection,
             selection.empty() ? "" : "\n", format_table(reduction_table(summary)),
             format_table(describe(body)), format_table(cost_table(cost)));
  std::vector<Json::Member> members = reduction_json(summary);
  members.emplace_back("frequencies_Hz", frequencies_json(body.omega));
  members.emplace_back("n_rigid", body.n_rigid);
  for (Json::Member& member : preparation_json(body)) members.push_back(std::move(member));
  write_summary(arguments, members, cost);
}

}  // namespace

void run_command(const ChladniArguments& arguments)
{
  const Scene scene = read_meshed_scene(arguments.scene.scene);
  ReduceSummary summary = reduce_with_progress(scene, arguments);
  // Both files are written at the end: a scene whose body cannot be made leaves none.
  PhaseClock clock;
  mbs_export::ModalBody body;
  on_first_rank([&] { body = make_body_of(scene, summary.reduced); });
  clock.end_phase("body");
  on_first_rank([&] { write_both_files(scene, arguments.scene, summary.reduced, body); });
  clock.end_phase("write");

  for (const PhaseTime& phase : clock.phases()) summary.phases.push_back(phase);
  summary.factorization = time_of_all_ranks(summary.factorization);
  const Cost cost = cost_of_all_ranks(summary.phases);
  on_first_rank([&] {
    print_and_write_summary(arguments.scene, summary, body, cost);
    fmt::print("\nwrote {}\nwrote {}\n", reduced_file(scene, arguments.scene).string(),
               body_file(scene, arguments.scene).string());
  });
}

}  // namespace chladni::cli
