#include <fmt/format.h>

#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "cli/describe.hpp"
#include "cli/petsc_session.hpp"
#include "mbs_export/reduced_file.hpp"

namespace chladni::cli {
namespace {

void print_and_write_summary(const SceneArguments& arguments, const ReduceSummary& summary,
                             const Cost& cost)
{
  fmt::print("{}\n\n{}\n{}\n{}", summary.reduced.title, format_table(reduction_table(summary)),
             format_table(describe(summary.reduced)), format_table(cost_table(cost)));
  std::vector<Json::Member> members = reduction_json(summary);
  members.emplace_back("frequencies_Hz",
                       frequencies_json(summary.reduced.fixed_interface_frequencies));
  write_summary(arguments, members, cost);
}

}  // namespace

void reduce_command(const ChladniArguments& arguments)
{
  const Scene scene = read_meshed_scene(arguments.scene.scene);
  ReduceSummary summary = reduce_with_progress(scene, arguments);
  const std::filesystem::path file = reduced_file(scene, arguments.scene);
  PhaseClock clock;
  on_first_rank([&] {
    make_folder(arguments.scene.output);
    mbs_export::write_reduced(file, summary.reduced);
  });
  clock.end_phase("write");
  summary.phases.push_back(clock.phases().front());
  summary.factorization = time_of_all_ranks(summary.factorization);
  const Cost cost = cost_of_all_ranks(summary.phases);
  on_first_rank([&] {
    print_and_write_summary(arguments.scene, summary, cost);
    fmt::print("\nwrote {}\n", file.string());
  });
}

}  // namespace chladni::cli
