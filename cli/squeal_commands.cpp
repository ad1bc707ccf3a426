#include "cli/squeal_commands.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "cases/squeal/condense.hpp"
#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep.hpp"
#include "cli/reserve_outputs.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "report/describe_body.hpp"
#include "report/describe_squeal.hpp"
#include "report/json.hpp"
#include "report/origin.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/scene.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study/study.hpp"
#include "squeal/transient/wav.hpp"

namespace chladni::cli {

using std::filesystem::path;

namespace {

void write_json(const std::string& file, const squeal::SquealResults& results,
                const report::Cost& cost)
{
  std::vector<report::Json::Member> members = {{"program", "squeal"}, {"version", report::version}};
  for (report::Json::Member& member : report::results_json(results))
    members.push_back(std::move(member));
  for (report::Json::Member& member : report::cost_json(cost)) members.push_back(std::move(member));
  files::write_text(file, report::Json::object(members).text() + "\n");
}

/// What perform needs beside the study.
struct Unfinished {
  path file;  ///< for the results
  squeal::RunOrigin origin;
  squeal::WavRecording* sound;  ///< null when there is none
  squeal::SquealResults begin;
};

/// The analyses, with their unfinished results in the file meanwhile.
squeal::SquealResults perform(const squeal::Brake& brake, const squeal::StudyOptions& study,
                              const Unfinished& unfinished)
{
  report::ProgressLine line;
  const squeal::StudyKeeping keeping{
      .progress = [&](const std::string& analysis, double whole) { line.show(analysis, whole); },
      .sound = unfinished.sound,
      .unfinished =
          [&](squeal::SquealResults results) {
            results.inputs = unfinished.origin.inputs;
            squeal::write_results(unfinished.file, results, unfinished.origin.provenance);
          },
      .begin = unfinished.begin};
  return squeal::run(brake, study, keeping);
}

/// The results at the end of a run. A failure of an analysis is told with that of the file.
void write_last(const path& file, const squeal::SquealResults& results,
                const squeal::RunOrigin& origin)
{
  try {
    squeal::write_results(file, results, origin.provenance);
  } catch (const Error& error) {
    if (!results.failure) throw;
    throw Error(fmt::format("{}; besides: {}", *results.failure, error.what()));
  }
}

/// @throws chladni::Error when the scene has nothing to do.
scene::Scene read_study(const RunArguments& arguments)
{
  scene::Scene scene = scene::read_scene(arguments.scene.scene);
  cases::require_study(scene);
  if (scene.squeal_model && !arguments.body_file.empty())
    throw Error(fmt::format("{}: squeal.model needs no --body; leave it out", scene.path));
  tell_notes(scene);
  return scene;
}

}  // namespace

void run_squeal(const RunArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = read_study(arguments);
  const cases::SquealFiles files =
      cases::squeal_files(scene, arguments.scene.output, arguments.body_file);
  cases::StaleChoice stale;
  if (arguments.body_file.empty()) stale = stale_of(arguments.scene);
  const std::optional<mbs_export::ModalBody> body = cases::body_for_squeal(scene, files, stale);
  const ReservedOutputs reserved = reserve_outputs(arguments.scene, {files.results, files.sound});
  const cases::SquealCase brake_case = cases::squeal_case(scene, body, files, stale);
  for (const std::string& note : brake_case.notes) fmt::print(stderr, "note: {}\n", note);
  const squeal::StudyOptions& study = cases::study_of(scene);
  clock.end_phase("read");

  const squeal::RunOrigin origin =
      cases::squeal_origin(scene, body, files, scene_file_of(arguments.scene));
  std::optional<squeal::WavRecording> sound;
  if (study.sound) sound.emplace(files.sound, study.sound->rate_Hz);
  std::error_code ignored;
  if (sound && !arguments.resume) std::filesystem::remove(files.sound, ignored);
  squeal::SquealResults results = perform(
      *brake_case.brake, study,
      {.file = files.results,
       .origin = origin,
       .sound = sound ? &*sound : nullptr,
       .begin = arguments.resume ? cases::resume(files.results, origin) : squeal::SquealResults{}});
  clock.end_phase("analyses");

  results.inputs = results.missing.empty() ? std::string() : origin.inputs;
  write_last(files.results, results, origin);
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());

  fmt::print("{}\n\n{}\n{}\nwrote {}\n", report::printable(scene.title),
             report::format_table(report::describe(results)),
             report::format_table(report::cost_table(cost)), files.results.string());
  if (sound && sound->full_scale())
    fmt::print("wrote {}, full scale {:.6g} m/s\n", files.sound.string(), *sound->full_scale());
  if (!arguments.scene.json.empty()) write_json(arguments.scene.json, results, cost);
  if (results.failure) throw Error(*results.failure);
}

namespace {

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

namespace {

/// "brake.condensed/pad.body.h5", as a scene names it.
std::string relative_name(const std::filesystem::path& file)
{
  return (file.parent_path().filename() / file.filename()).generic_string();
}

report::TextTable table_of(const cases::CondensedBrake& brake)
{
  report::TextTable table{.header = {"part", "body", "coordinates before", "after"}, .rows = {}};
  Eigen::Index before = 0, after = 0;
  for (const cases::CondensedPart& part : brake.parts) {
    table.rows.push_back({part.name, report::printable(relative_name(part.file)),
                          fmt::format("{}", part.before), fmt::format("{}", part.after)});
    before += part.before;
    after += part.after;
  }
  table.rows.push_back({"all", "", fmt::format("{}", before), fmt::format("{}", after)});
  return table;
}

void write_json(const std::string& file, const cases::CondensedBrake& brake,
                const report::Cost& cost)
{
  std::vector<report::Json> parts;
  for (const cases::CondensedPart& part : brake.parts) {
    parts.push_back(report::Json::object({{"part", part.name},
                                          {"file", part.file.string()},
                                          {"coordinates_before", int(part.before)},
                                          {"coordinates", int(part.after)}}));
  }
  const squeal::CondensationError& error = brake.found.error;
  std::vector<report::Json::Member> members = {{"program", "squeal"},
                                               {"version", report::version},
                                               {"parts", report::Json::array(parts)},
                                               {"error", error.eigenvalues},
                                               {"growth_error_1_s", error.growth},
                                               {"eigenvalues", error.n_eigenvalues},
                                               {"states", error.n_states},
                                               {"unstable_beyond", error.n_unstable_beyond}};
  for (report::Json::Member& member : report::cost_json(cost)) members.push_back(std::move(member));
  files::write_text(file, report::Json::object(members).text() + "\n");
}

}  // namespace

void declare_condense(CLI::App& app, CondenseArguments& arguments)
{
  CLI::App* condense = app.add_subcommand(
      "condense", "makes small bodies of an assembly's large ones, for its vibrations in a band");
  declare_scene_arguments(*condense, arguments.scene);
  declare_stale(*condense, arguments.scene.stale);
  condense
      ->add_option("--tolerance", arguments.tolerance,
                   "largest relative error of a complex eigenvalue of the brake")
      ->type_name("ERROR")
      ->check(CLI::Range(1e-7, 0.5))
      ->capture_default_str();
  condense->add_option("--up-to-Hz", arguments.up_to_Hz, "the band: all oscillations up to here")
      ->type_name("HZ")
      ->check(CLI::Range(1e-3, 1e9))
      ->required();
  condense->footer(
      "The bodies are those of this brake: of its speeds, of friction from none to the scene's,\n"
      "and of no oscillation above the band. Name them in another scene:\n"
      "body = \"NAME.condensed/PART.body.h5\". The tolerance is relative to |lambda|: 1e-3 at 2 "
      "kHz\n"
      "is up to 13 1/s of growth; the largest error of a growth rate is printed.\n\n"
      "Example:\n"
      "  squeal condense scene.toml --output out --up-to-Hz 3000 --tolerance 1e-3");
}

void run_condense(const CondenseArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = scene::read_scene(arguments.scene.scene);
  cases::require_study(scene);
  tell_notes(scene);
  const cases::SquealFiles files = cases::squeal_files(scene, arguments.scene.output, {});
  const std::vector<std::filesystem::path> outputs = cases::condensed_files(scene, files);
  report::make_folder(outputs.front().parent_path());
  // Their folder has the name of the scene: nothing else writes there.
  SceneArguments own = arguments.scene;
  own.overwrite = true;
  const ReservedOutputs reserved = reserve_outputs(own, outputs);
  const cases::CondensedBrake brake =
      cases::condensed_brake(scene, files, stale_of(arguments.scene),
                             {.tolerance = arguments.tolerance, .up_to_Hz = arguments.up_to_Hz});
  clock.end_phase("condense");
  cases::write(brake);
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());
  const squeal::CondensationError& error = brake.found.error;
  fmt::print(
      "{}\n\n{}\n{} eigenvalues up to {:.6g} Hz, in {} states of the brake, have errors up to "
      "{:.2g}, their growth rates up to {:.2g} 1/s\n",
      report::printable(scene.title), report::format_table(table_of(brake)), error.n_eigenvalues,
      arguments.up_to_Hz, error.n_states, error.eigenvalues, error.growth);
  if (error.n_unstable_beyond > 0) {
    fmt::print(
        "note: up to {} motions above {:.6g} Hz are unstable with these bodies; what lies "
        "there is not the brake's\n",
        error.n_unstable_beyond, arguments.up_to_Hz);
  }
  fmt::print("\n{}", report::format_table(report::cost_table(cost)));
  if (!arguments.scene.json.empty()) write_json(arguments.scene.json, brake, cost);
}

}  // namespace chladni::cli
