#include "cli/squeal_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "cases/squeal/resume.hpp"
#include "cases/squeal/squeal_case.hpp"
#include "cli/reserve_outputs.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "report/cost.hpp"
#include "report/describe.hpp"
#include "report/json.hpp"
#include "report/origin.hpp"
#include "report/output.hpp"
#include "report/progress.hpp"
#include "report/squeal_json.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/scene.hpp"
#include "squeal/results/result_file.hpp"
#include "squeal/study/run.hpp"
#include "squeal/transient/checkpoint.hpp"
#include "squeal/transient/wav_spool.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

/// What a run that was interrupted has left behind is of no use to one that begins anew.
/// @throws chladni::Error when there is a state, and nobody has said that it may go.
void forget(const cases::SquealFiles& files, const SceneArguments& arguments)
{
  if (exists(files.checkpoint) && !arguments.overwrite) {
    throw Error(fmt::format(
        "{}: holds the state of an interrupted run; continue it with --resume, or start "
        "again with --overwrite",
        files.checkpoint.string()));
  }
  std::error_code ignored;
  std::filesystem::remove(files.checkpoint, ignored);
  std::filesystem::remove(files.spool, ignored);
}

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
  squeal::Checkpoint* checkpoint;
  squeal::WavSpool* sound;  ///< null when there is none
  squeal::SquealResults begin;
};

/// The analyses, with their unfinished results in the file meanwhile.
squeal::SquealResults perform(const squeal::Brake& brake, const squeal::StudyOptions& study,
                              const Unfinished& unfinished)
{
  report::ProgressLine line;
  const squeal::StudyKeeping keeping{
      .progress = [&](const std::string& analysis, double whole) { line.show(analysis, whole); },
      .checkpoint = unfinished.checkpoint,
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
  if (!(arguments.checkpoint_interval >= 0.0))
    throw Error("--checkpoint: the time between two checkpoints must be 0 s or more");
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
  const ReservedOutputs reserved =
      reserve_outputs(arguments.scene, {files.results, files.sound, files.checkpoint});
  const cases::SquealCase brake_case = cases::squeal_case(scene, body, files, stale);
  for (const std::string& note : brake_case.notes) fmt::print(stderr, "note: {}\n", note);
  const squeal::StudyOptions& study = cases::study_of(scene);
  clock.end_phase("read");

  const squeal::RunOrigin origin =
      cases::squeal_origin(scene, body, files, scene_file_of(arguments.scene));
  squeal::Checkpoint checkpoint(files.checkpoint, origin, arguments.checkpoint_interval);
  std::optional<squeal::WavSpool> sound;
  if (study.sound) sound.emplace(files.sound, files.spool, study.sound->rate_Hz);
  if (!arguments.resume) forget(files, arguments.scene);
  std::error_code ignored;
  if (sound && !arguments.resume) std::filesystem::remove(files.sound, ignored);
  squeal::SquealResults results =
      perform(*brake_case.brake, study,
              {.file = files.results,
               .origin = origin,
               .checkpoint = &checkpoint,
               .sound = sound ? &*sound : nullptr,
               .begin = arguments.resume
                            ? cases::resume({files.results, files.checkpoint}, origin, checkpoint)
                            : squeal::SquealResults{}});
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
  if (!checkpoint.failure().empty()) {
    fmt::print(stderr, "note: a state could not be written: {}\n",
               report::printable(checkpoint.failure()));
  }
  if (results.failure) throw Error(*results.failure);
  checkpoint.remove();
  if (sound) sound->remove();
}

}  // namespace chladni::cli
