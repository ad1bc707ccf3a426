#include "cli/squeal_sweep.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>

#include "cases/squeal/resume.hpp"
#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep.hpp"
#include "cases/squeal/sweep_study.hpp"
#include "cases/squeal/sweep_values.hpp"
#include "cli/reserve_outputs.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "report/cost.hpp"
#include "report/describe_sweep.hpp"
#include "report/json.hpp"
#include "report/progress.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "squeal/results/sweep_file.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

struct SweepFiles {
  path table, csv;
};

cases::SweepValues values_of(const SweepArguments& arguments)
{
  if (arguments.samples.empty() == arguments.vary.empty()) {
    throw Error(
        "squeal sweep: give --vary KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., once for each key of "
        "a "
        "grid, or --samples FILE");
  }
  return arguments.samples.empty() ? cases::sweep_grid(arguments.vary)
                                   : cases::read_samples(arguments.samples);
}

/// The sweep with its table in the file now and then.
squeal::SweepTable perform(const cases::SweepCase& sweep, squeal::SweepTable table,
                           const SweepArguments& arguments,
                           const std::function<void(const squeal::SweepTable&)>& write)
{
  using Clock = std::chrono::steady_clock;
  report::ProgressLine line;
  std::size_t n_done = table.n_variants() - table.count(squeal::VariantState::to_do);
  Clock::time_point written = Clock::now();
  const auto done_another = [&](const squeal::SweepTable& now) {
    line.show("variants", double(++n_done) / double(now.n_variants()));
    if (Clock::now() - written < std::chrono::duration<double>(arguments.checkpoint_interval))
      return;
    write(now);
    written = Clock::now();
  };
  return cases::sweep(sweep, std::move(table), {done_another, arguments.n_threads});
}

void write_json(const std::string& file, const squeal::SweepTable& sweep, const report::Cost& cost)
{
  std::vector<report::Json::Member> members = {{"program", "squeal"}, {"version", report::version}};
  for (report::Json::Member& member : report::sweep_json(sweep))
    members.push_back(std::move(member));
  for (report::Json::Member& member : report::cost_json(cost)) members.push_back(std::move(member));
  files::write_text(file, report::Json::object(members).text() + "\n");
}

}  // namespace

void declare_sweep(CLI::App& app, SweepArguments& arguments)
{
  CLI::App* sweep = app.add_subcommand(
      "sweep",
      "analyses variants of a scene with other values of its keys: NAME.sweep.h5, NAME.sweep.csv");
  declare_scene_arguments(*sweep, arguments.scene);
  declare_stale(*sweep, arguments.scene.stale);
  sweep
      ->add_option("--vary", arguments.vary,
                   "a key of [squeal] and its values; with several keys, all combinations")
      ->type_name("KEY=FROM:TO:COUNT|KEY=VALUE,...")
      ->allow_extra_args(false);
  sweep
      ->add_option("--samples", arguments.samples,
                   "file of comma-separated values: keys in the first line, one variant in each "
                   "further line")
      ->type_name("FILE");
  sweep
      ->add_option(
          "--analyses", arguments.analyses,
          "names separated by commas; default: those of the scene that yield single numbers")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  sweep->add_flag("--resume", arguments.resume,
                  "continues an interrupted sweep; to start again use --overwrite");
  sweep
      ->add_option("--checkpoint", arguments.checkpoint_interval,
                   "time between two writes of the table to its file, for --resume")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  sweep
      ->add_option("--threads", arguments.n_threads,
                   "number of variants computed at a time; 0: one per processor")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  sweep->add_option("--body", arguments.body_file, "body file; default: NAME.body.h5 in DIR")
      ->type_name("FILE");
  sweep->footer(
      "Examples:\n"
      "  squeal sweep scene.toml --vary squeal.friction=0.3:0.6:10\n"
      "  squeal sweep scene.toml --vary squeal.friction=0.3,0.5 "
      "--vary squeal.pads.stiffness=4e6:8e6:5\n"
      "  squeal sweep scene.toml --samples samples.csv --output out\n"
      "  squeal sweep scene.toml --samples samples.csv --output out --resume");
}

void run_sweep(const SweepArguments& arguments)
{
  report::PhaseClock clock;
  cases::StaleChoice stale;
  if (arguments.body_file.empty()) stale = stale_of(arguments.scene);
  cases::SweepStudy study = cases::sweep_study({.scene = arguments.scene.scene,
                                                .folder = arguments.scene.output,
                                                .body = arguments.body_file,
                                                .values = values_of(arguments),
                                                .analyses = arguments.analyses,
                                                .stale = stale},
                                               scene_file_of(arguments.scene));
  const path stem = path(arguments.scene.output) / study.sweep.scene.name;
  const SweepFiles files{stem.string() + ".sweep.h5", stem.string() + ".sweep.csv"};
  const ReservedOutputs reserved = reserve_outputs(arguments.scene, {files.table, files.csv});
  for (const std::string& note : study.notes) fmt::print(stderr, "note: {}\n", note);
  cases::check_variants(study.sweep, study.table);
  if (arguments.resume)
    study.table = cases::resume(files.table, study.table, study.origin);
  else if (!arguments.scene.overwrite)
    cases::require_no_unfinished_sweep(files.table);
  clock.end_phase("read");
  const auto write = [&](const squeal::SweepTable& table) {
    squeal::write_sweep(files.table, table, study.origin.provenance);
  };
  write(study.table);
  const squeal::SweepTable table = perform(study.sweep, study.table, arguments, write);
  clock.end_phase("variants");
  write(table);
  files::write_text(files.csv.string(), squeal::csv_of(table));
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());
  fmt::print("{}\n\n{}\n{}\nwrote {} and {}\n", report::printable(study.sweep.scene.title),
             report::format_table(report::describe(table)),
             report::format_table(report::cost_table(cost)), files.table.string(),
             files.csv.string());
  if (!arguments.scene.json.empty()) write_json(arguments.scene.json, table, cost);
  if (table.count(squeal::VariantState::done) == 0)
    throw Error(fmt::format("all variants failed; the first: {}", table.failures.front()));
}

}  // namespace chladni::cli
