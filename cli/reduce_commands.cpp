#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <numbers>

#include "cases/compare_reductions.hpp"
#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/describe_body.hpp"
#include "report/json.hpp"
#include "report/origin.hpp"

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

namespace {

/// The body of a reduction that is in its file already: what is wrong with [body] costs no second
/// one.
mbs_export::ModalBody body_of(const scene::Scene& scene, const SceneArguments& arguments,
                              const mbs_export::ReducedSystem& reduced)
{
  try {
    return make_body_of(scene, reduced);
  } catch (const Error& error) {
    throw Error(fmt::format(
        "{}\nThe reduction is kept in {}; correct [body] and continue with `chladni body {} "
        "--output {}`",
        error.what(), reduced_file(scene, arguments).string(), arguments.scene, arguments.output));
  }
}

void print_and_write_summary(const SceneArguments& arguments, const cases::ReduceSummary& summary,
                             const mbs_export::ModalBody& body, const report::Cost& cost)
{
  const std::string selection = report::describe_selection(body);
  fmt::print("{}\n\n{}\n{}{}{}\n{}\n{}", report::printable(body.title),
             report::format_table(report::list_modes(body)), selection,
             selection.empty() ? "" : "\n", cases::described_reduction(summary),
             report::format_table(report::describe(body)),
             report::format_table(report::cost_table(cost)));
  std::vector<report::Json::Member> members = cases::reduction_json(summary);
  members.emplace_back("frequencies_Hz", report::frequencies_json(body.omega));
  members.emplace_back("n_rigid", body.n_rigid);
  for (report::Json::Member& member : report::preparation_json(body))
    members.push_back(std::move(member));
  write_summary(arguments, members, cost);
}

}  // namespace

void run_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments);
  const SceneArguments& said = arguments.scene;
  const ReservedOutputs reserved =
      reserve_on_first_rank(said, {reduced_file(scene, said), body_file(scene, said)});
  cases::ReduceSummary summary =
      cases::reduce_scene(scene, said_of_solvers(arguments), line_of_progress(scene));
  summary.reduced.provenance.scene_file = scene_file_of(said);
  report::PhaseClock clock;
  cases::on_first_rank(
      [&] { mbs_export::write_reduced(reduced_file(scene, said), summary.reduced); });
  clock.end_phase("write");
  mbs_export::ModalBody body;
  cases::on_first_rank([&] { body = body_of(scene, said, summary.reduced); });
  clock.end_phase("body");
  cases::on_first_rank([&] { mbs_export::write_body(body_file(scene, said), body); });
  clock.end_phase("write body");

  for (const report::PhaseTime& phase : clock.phases()) summary.phases.push_back(phase);
  summary.factorization = time_of_all_ranks(summary.factorization);
  const report::Cost cost = cost_of_all_ranks(summary.phases);
  cases::on_first_rank([&] {
    print_and_write_summary(said, summary, body, cost);
    fmt::print("\nwrote {}\nwrote {}\n", reduced_file(scene, said).string(),
               body_file(scene, said).string());
  });
}

namespace {

void print_comparison(const SceneArguments& arguments, const scene::Scene& scene,
                      const cases::ReductionComparison& found)
{
  fmt::print(
      "{}\n\n{} DOFs; the first {} elastic frequencies under the supports of the body, {:.5g} to "
      "{:.5g} Hz, by the FE model in {:.3f} CPU s\n\n{}",
      report::printable(scene.title), found.n_dofs, found.omega.size(),
      found.omega[0] / (2.0 * std::numbers::pi),
      found.omega[found.omega.size() - 1] / (2.0 * std::numbers::pi), found.modes_cpu_s,
      report::format_table(cases::comparison_table(found)));
  for (const cases::ComparedReduction& row : found.reductions)
    if (!row.refusal.empty())
      fmt::print("{} with {}: {}\n", row.method, row.asked, report::printable(row.refusal));
  write_summary(arguments, cases::comparison_json(found), report::cost_so_far({}));
}

}  // namespace

void compare_command(const ChladniArguments& arguments)
{
  const scene::Scene scene = read_scene_to_mesh(arguments);
  const std::filesystem::path file =
      std::filesystem::path(arguments.scene.output) / (scene.name + ".compare.svg");
  const ReservedOutputs reserved = reserve_on_first_rank(arguments.scene, {file});
  cases::ReduceProgress bar =
      progress_bar({{"mesh", 5.0}, {"assembly", 5.0}, {"modes", 10.0}, {"reductions", 80.0}});
  const cases::ReductionComparison found = cases::compare_reductions(
      scene, {.n_frequencies = arguments.compare.n_frequencies, .modes = arguments.compare.modes},
      arguments.solver, bar);
  bar = {};
  cases::on_first_rank([&] {
    files::write_text(file, cases::comparison_picture(found) + writer_mark(arguments.scene));
    print_comparison(arguments.scene, scene, found);
    fmt::print("\nwrote {}\n", file.string());
  });
}

void declare_compare(CLI::App& compare, CompareChoice& choice)
{
  compare.add_option("--modes", choice.modes, "numbers of modes that each method is tried with")
      ->type_name("N")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  compare
      .add_option("--frequencies", choice.n_frequencies,
                  "number of elastic frequencies, of the supported body, that are compared")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

}  // namespace chladni::cli
