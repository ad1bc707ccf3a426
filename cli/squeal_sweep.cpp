#include "cli/squeal_sweep.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep.hpp"
#include "cases/squeal/sweep_columns.hpp"
#include "cases/squeal/sweep_values.hpp"
#include "cli/reserve_outputs.hpp"
#include "common/error.hpp"
#include "files/hdf5.hpp"
#include "files/text_file.hpp"
#include "mbs_export/files/provenance.hpp"
#include "report/cost.hpp"
#include "report/describe_sweep.hpp"
#include "report/json.hpp"
#include "report/progress.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/changes.hpp"
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

/// The analyses of each variant.
/// @throws chladni::Error when the scene has none of which a sweep keeps a number.
std::vector<std::string> analyses_of(const SweepArguments& arguments, const scene::Scene& scene)
{
  if (!arguments.analyses.empty()) return arguments.analyses;
  std::vector<std::string> analyses = cases::study_of(scene).analyses;
  std::erase_if(analyses, [](const std::string& name) { return !cases::has_sweep_columns(name); });
  if (analyses.empty()) {
    throw Error(
        fmt::format("{}: no analysis of the scene yields single numbers; choose others with "
                    "--analyses, as in --analyses critical-speed",
                    scene.path));
  }
  return analyses;
}

/// The sweep that a file holds, if it is the one that is asked for.
squeal::SweepTable resumed(const path& file, const squeal::SweepTable& wanted,
                           const squeal::RunOrigin& origin)
{
  if (!exists(file))
    throw Error(fmt::format("--resume: there is no {}; run without --resume", file.string()));
  const files::Reader reader(file.string());
  squeal::SweepTable left = squeal::read_sweep(reader);
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("{}: cannot be resumed, since {}; --overwrite begins anew",
                            file.string(), why));
  };
  if (left.count(squeal::VariantState::to_do) == 0) refuse("no variant is left to do");
  if (left.keys != wanted.keys) refuse("other keys vary");
  if (left.values.rows() != wanted.values.rows() || left.values != wanted.values)
    refuse("the keys take other values");
  const auto changed = scene::changed_keys(mbs_export::file_parts::read_provenance(reader).scene,
                                           origin.provenance.scene, scene::Step::squeal);
  if (!changed.empty()) refuse("the scene has changed: " + changed.front());
  if (left.columns != wanted.columns || left.inputs != wanted.inputs)
    refuse(fmt::format("it was made from {}, and this run has {}", left.inputs, wanted.inputs));
  return left;
}

/// @throws chladni::Error where an unfinished sweep would be lost, and nobody has said that it may.
void keep_unfinished(const path& file, const SweepArguments& arguments)
{
  if (arguments.scene.overwrite || !exists(file)) return;
  const files::Reader reader(file.string());
  if (reader.text_attribute("/", "format") != squeal::sweep_format) return;
  const squeal::SweepTable left = squeal::read_sweep(reader);
  if (left.count(squeal::VariantState::to_do) == 0) return;
  throw Error(
      fmt::format("{}: a sweep that was interrupted; --resume goes on from it, --overwrite begins "
                  "anew",
                  file.string()));
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
  const auto count = [&](squeal::VariantState state) { return report::Json(sweep.count(state)); };
  std::vector<report::Json> failures;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty()) continue;
    failures.push_back(report::Json::object(
        {{"variant", i + 1}, {"of", name_of_variant(sweep, i)}, {"reason", sweep.failures[i]}}));
  }
  std::vector<report::Json::Member> members = {{"program", "squeal"},
                                               {"version", report::version},
                                               {"variants", sweep.n_variants()},
                                               {"done", count(squeal::VariantState::done)},
                                               {"failed", count(squeal::VariantState::failed)},
                                               {"failures", report::Json::array(failures)}};
  for (report::Json::Member& member : report::cost_json(cost)) members.push_back(std::move(member));
  files::write_text(file, report::Json::object(members).text() + "\n");
}

/// The scene, what varies in it, and what the variants share.
struct SweepStudy {
  cases::SweepCase sweep;
  squeal::SweepTable table;  ///< all variants to do
  squeal::RunOrigin origin;
  std::vector<std::string> notes;
};

SweepStudy read_study(const SweepArguments& arguments)
{
  const cases::SweepValues wanted = values_of(arguments);
  const scene::Scene scene = scene::read_scene(arguments.scene.scene);
  cases::require_study(scene);
  std::vector<std::vector<scene::NumberPlace>> places;
  for (const std::string& key : wanted.keys)
    places.push_back(scene::places_of_squeal_key(scene, key));
  squeal::StudyOptions options = cases::study_of(scene);
  options.analyses = analyses_of(arguments, scene);
  squeal::SweepTable table =
      squeal::empty_sweep(wanted.keys, wanted.values, cases::sweep_columns(options));
  const cases::SquealFiles files =
      cases::squeal_files(scene, arguments.scene.output, arguments.body_file);
  cases::StaleChoice stale;
  if (arguments.body_file.empty()) stale = stale_of(arguments.scene);
  const auto body = cases::body_for_squeal(scene, files, stale);
  cases::SquealCase brake_case = cases::squeal_case(scene, body, files, stale);
  squeal::RunOrigin origin =
      cases::squeal_origin(scene, body, files, scene_file_of(arguments.scene));
  table.inputs = origin.inputs;
  const auto make_brake = [body, files](const scene::Scene& variant) {
    return std::shared_ptr<const squeal::Brake>(
        cases::squeal_case(variant, body, files, std::nullopt).brake);
  };
  return {.sweep = {scene, options.analyses, std::move(places), std::move(brake_case.brake),
                    make_brake},
          .table = std::move(table),
          .origin = std::move(origin),
          .notes = std::move(brake_case.notes)};
}

}  // namespace

void declare_sweep(CLI::App& app, SweepArguments& arguments)
{
  CLI::App* sweep =
      app.add_subcommand("sweep", "analyses many variants of a scene: other numbers in its keys");
  declare_scene_arguments(*sweep, arguments.scene);
  declare_stale(*sweep, arguments.scene.stale);
  sweep
      ->add_option("--vary", arguments.vary,
                   "a key of [squeal] and its values; several keys make a grid")
      ->type_name("KEY=FROM:TO:COUNT|KEY=VALUE,...")
      ->allow_extra_args(false);
  sweep
      ->add_option("--samples", arguments.samples,
                   "comma-separated values: keys in the first line, a variant in each other one")
      ->type_name("FILE");
  sweep
      ->add_option("--analyses", arguments.analyses,
                   "separated by commas; default: those of the scene that yield single numbers")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  sweep->add_flag("--resume", arguments.resume,
                  "goes on from where a sweep was interrupted; --overwrite begins anew");
  sweep
      ->add_option("--checkpoint", arguments.checkpoint_interval,
                   "seconds between two states of the table in its file, for --resume")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  sweep->add_option("--threads", arguments.n_threads, "variants at a time; 0: one for a processor")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  sweep->add_option("--body", arguments.body_file, "the body; default: NAME.body.h5 in DIR")
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
  SweepStudy study = read_study(arguments);
  const path stem = path(arguments.scene.output) / study.sweep.scene.name;
  const SweepFiles files{stem.string() + ".sweep.h5", stem.string() + ".sweep.csv"};
  const ReservedOutputs reserved = reserve_outputs(arguments.scene, {files.table, files.csv});
  for (const std::string& note : study.notes) fmt::print(stderr, "note: {}\n", note);
  cases::check_variants(study.sweep, study.table);
  if (arguments.resume)
    study.table = resumed(files.table, study.table, study.origin);
  else
    keep_unfinished(files.table, arguments);
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
