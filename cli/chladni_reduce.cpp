#include <fmt/format.h>
#include "cases/describe_reduction.hpp"
#include "report/numbers_json.hpp"

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "report/describe.hpp"

namespace chladni::cli {
namespace {

void print_and_write_summary(const SceneArguments& arguments, const cases::ReduceSummary& summary,
                             const report::Cost& cost)
{
  fmt::print("{}\n\n{}\n{}\n{}", report::printable(summary.reduced.title),
             cases::described_reduction(summary),
             report::format_table(report::describe(summary.reduced)),
             report::format_table(report::cost_table(cost)));
  std::vector<report::Json::Member> members = cases::reduction_json(summary);
  members.emplace_back("frequencies_Hz",
                       report::frequencies_json(summary.reduced.fixed_interface_frequencies));
  write_summary(arguments, members, cost);
}

}  // namespace

void reduce_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments);
  const std::filesystem::path file = reduced_file(scene, arguments.scene);
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceSummary summary =
      cases::reduce_scene(scene, said_of_solvers(arguments), line_of_progress(scene));
  report::PhaseClock clock;
  summary.reduced.provenance.scene_file = scene_file_of(arguments.scene);
  cases::on_first_rank([&] { mbs_export::write_reduced(file, summary.reduced); });
  clock.end_phase("write");
  summary.phases.push_back(clock.phases().front());
  summary.factorization = time_of_all_ranks(summary.factorization);
  const report::Cost cost = cost_of_all_ranks(summary.phases);
  cases::on_first_rank([&] {
    print_and_write_summary(arguments.scene, summary, cost);
    fmt::print("\nwrote {}\n", file.string());
  });
}

}  // namespace chladni::cli
