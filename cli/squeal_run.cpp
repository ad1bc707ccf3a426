#include "cli/squeal_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "cli/reserve_outputs.hpp"
#include "cli/squeal_resume.hpp"
#include "common/error.hpp"
#include "files/hdf5.hpp"
#include "files/text_file.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/provenance.hpp"
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
#include "squeal/brake/disc.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/model_brake.hpp"
#include "squeal/results/result_file.hpp"
#include "squeal/study/run.hpp"
#include "squeal/transient/checkpoint.hpp"
#include "squeal/transient/wav_spool.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

mbs_export::ModalBody read_body_of(const path& file, const SceneArguments& arguments)
{
  if (!std::filesystem::exists(file)) {
    throw Error(
        fmt::format("{}: no such file; make it with `chladni run {} --output {}`, or name "
                    "another one with --body",
                    file.string(), arguments.scene, arguments.output));
  }
  return mbs_export::read_body(file);
}

/// The body in the file of this name is taken to be that of the scene; one that --body names is
/// what the user says.
void require_of_scene(const scene::Scene& scene, const path& file,
                      const mbs_export::ModalBody& body, const SceneArguments& arguments)
{
  report::require_of_scene(scene,
                           {.file = file, .what = report::Made::body, .origin = body.provenance},
                           stale_of(arguments));
}

/// A file of radiation, and what to do with one of another scene; nothing where --body names a body
/// that is not the scene's.
struct RadiationFile {
  path file;
  std::optional<report::Stale> stale;
};

squeal::Radiation read_radiation_of(const RadiationFile& source, const scene::Scene& scene)
{
  const path& file = source.file;
  if (!std::filesystem::exists(file)) {
    throw Error(
        fmt::format("{0}: no such file, but squeal.radiation = true needs it; make it with "
                    "`chladni sound {1} --radiation --output {2}`",
                    file.string(), scene.path, file.parent_path().string()));
  }
  const files::Reader reader(file.string());
  squeal::Radiation radiation = squeal::read_radiation(reader);
  if (!source.stale || !reader.contains("provenance/scene")) return radiation;
  const auto origin = mbs_export::file_parts::read_provenance(reader);
  report::require_of_scene(scene, {.file = file, .what = report::Made::radiation, .origin = origin},
                           *source.stale);
  return radiation;
}

struct Files {
  path body, radiation;    ///< read
  path results, sound;     ///< written
  path checkpoint, spool;  ///< written while the run lasts
};

Files files_of(const scene::Scene& scene, const path& folder, const path& body)
{
  const auto with = [&](const char* extension) { return folder / (scene.name + extension); };
  return {.body = body.empty() ? with(".body.h5") : body,
          .radiation = with(".radiation.h5"),
          .results = with(".squeal.h5"),
          .sound = with(".wav"),
          .checkpoint = with(".checkpoint.h5"),
          .spool = with(".checkpoint.sound")};
}

/// Where the results of this run come from.
squeal::RunOrigin origin_of(const scene::Scene& scene, const SceneArguments& arguments,
                            const std::optional<mbs_export::ModalBody>& body, const Files& files)
{
  mbs_export::Provenance origin;
  origin.ranks = 1;
  if (body) {
    origin = body->provenance;
    origin.body_scene = origin.scene;
  }
  origin.scene = scene.text;
  origin.versions = body ? fmt::format("squeal {}; body: {}", report::version, origin.versions)
                         : fmt::format("squeal {}", report::version);
  origin.scene_file = scene_file_of(arguments);
  return {std::move(origin),
          inputs_of(body ? files.body : path(), scene.radiation ? files.radiation : path())};
}

/// The brake of the scene: a flexible disc, damped by `radiation` if the scene says so, or a model
/// without a body.
std::unique_ptr<squeal::Brake> brake_of(const scene::Scene& scene,
                                        const std::optional<mbs_export::ModalBody>& body,
                                        const RadiationFile& radiation)
{
  if (!body) return squeal::model_brake(scene.squeal_model.value());
  const squeal::SquealOptions& options = scene.squeal.value();
  squeal::Disc disc = squeal::make_disc(*body, squeal::ring_choice(options), options.modes);
  if (scene.radiation)
    disc = squeal::with_radiation(std::move(disc), read_radiation_of(radiation, scene));
  for (const std::string& note : squeal::notes_of(disc)) fmt::print(stderr, "note: {}\n", note);
  return std::make_unique<squeal::FlexibleDisc>(std::move(disc), options);
}

const squeal::StudyOptions& study_of(const scene::Scene& scene)
{
  return scene.squeal ? scene.squeal->study : scene.squeal_model.value().study;
}

/// What a run that was interrupted has left behind is of no use to one that begins anew.
/// @throws chladni::Error when there is a state, and nobody has said that it may go.
void forget(const Files& files, const SceneArguments& arguments)
{
  if (exists(files.checkpoint) && !arguments.overwrite) {
    throw Error(
        fmt::format("{}: the state of a run that was interrupted; --resume goes on from it, "
                    "--overwrite begins anew",
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
  if (!scene.squeal && !scene.squeal_model)
    throw Error(fmt::format("{}: there is no table [squeal], so nothing to do", scene.path));
  if (!(arguments.checkpoint_interval >= 0.0))
    throw Error("--checkpoint: give the seconds between two states of a transient, 0 or more");
  if (scene.squeal_model && !arguments.body_file.empty())
    throw Error(fmt::format("{}: squeal.model needs no body; leave out --body", scene.path));
  tell_notes(scene);
  return scene;
}

}  // namespace

void run_squeal(const RunArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = read_study(arguments);
  const Files files = files_of(scene, arguments.scene.output, arguments.body_file);
  std::optional<mbs_export::ModalBody> body;
  if (!scene.squeal_model) body = read_body_of(files.body, arguments.scene);
  if (body && arguments.body_file.empty())
    require_of_scene(scene, files.body, *body, arguments.scene);
  const ReservedOutputs reserved =
      reserve_outputs(arguments.scene, {files.results, files.sound, files.checkpoint});
  RadiationFile radiation{.file = files.radiation, .stale = {}};
  if (arguments.body_file.empty()) radiation.stale = stale_of(arguments.scene);
  const std::unique_ptr<squeal::Brake> brake = brake_of(scene, body, radiation);
  const squeal::StudyOptions& study = study_of(scene);
  clock.end_phase("read");

  const squeal::RunOrigin origin = origin_of(scene, arguments.scene, body, files);
  squeal::Checkpoint checkpoint(files.checkpoint, origin, arguments.checkpoint_interval);
  std::optional<squeal::WavSpool> sound;
  if (study.sound) sound.emplace(files.sound, files.spool, study.sound->rate_Hz);
  if (!arguments.resume) forget(files, arguments.scene);
  std::error_code ignored;
  if (sound && !arguments.resume) std::filesystem::remove(files.sound, ignored);
  squeal::SquealResults results = perform(
      *brake, study,
      {.file = files.results,
       .origin = origin,
       .checkpoint = &checkpoint,
       .sound = sound ? &*sound : nullptr,
       .begin = arguments.resume ? resume({files.results, files.checkpoint}, origin, checkpoint)
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
