#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/fe/sound_report.hpp"
#include "report/fe/vtu.hpp"
#include "report/origin.hpp"
#include "report/progress.hpp"
#include "report/version.hpp"
#include "sound/sound_file.hpp"
#include "sound/study.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/transient/wav.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

void need(const path& file, const std::string& remedy)
{
  if (!std::filesystem::exists(file))
    throw Error(fmt::format("{}: no such file; {}", file.string(), remedy));
}

/// NAME.sound.wav, when the scene asks for it.
void write_wav(const scene::Scene& scene, const path& file, const sound::SoundResults& results,
               const sound::Onset& onset)
{
  if (!scene.sound->wav) return;
  const sound::WavCase& wav = *scene.sound->wav;
  std::size_t i = 0;
  while (results.microphones[i].name != wav.microphone) ++i;
  const auto samples = sound::samples(results.tones, results.heard[i].pressure, wav, onset);
  const double scale = squeal::write_wav(file, samples, wav.rate_Hz, "Pa");
  fmt::print("wrote {}, full scale {:.6g} Pa\n", file.string(), scale);
}

struct SoundFiles {
  path body, squeal, sound, radiation, picture, wav;
};

SoundFiles sound_files(const scene::Scene& scene, const SceneArguments& arguments)
{
  const path stem = path(arguments.output) / scene.name;
  const auto with = [&](const char* extension) { return path(stem.string() + extension); };
  return {with(".body.h5"),      with(".squeal.h5"), with(".sound.h5"),
          with(".radiation.h5"), with(".sound.vtu"), with(".sound.wav")};
}

/// Where the numbers come from.
mbs_export::Provenance origin_of(const scene::Scene& scene, const SceneArguments& arguments,
                                 const mbs_export::ModalBody& body)
{
  mbs_export::Provenance origin = body.provenance;
  origin.body_scene = std::exchange(origin.scene, scene.text);
  origin.scene_file = scene_file_of(arguments);
  origin.versions = fmt::format("chladni {}; body: {}", report::version, origin.versions);
  return origin;
}

/// Writes what there is of the results: the radiation before there are tones, then these.
void write_found(const scene::Scene& scene, const SoundFiles& files,
                 const sound::SoundResults& results, const mbs_export::Provenance& origin)
{
  if (results.tones.empty()) {
    squeal::write_radiation(files.radiation, results.radiation, scene.title, origin);
  } else {
    sound::write_sound(files.sound, results, origin);
    files::write_text(files.picture, report::sound_vtu(results.tones));
  }
}

ReservedOutputs reserve(const SceneArguments& arguments, const SoundFiles& files,
                        const SoundChoice& choice)
{
  if (choice.radiation_only) return reserve_outputs(arguments, {files.radiation});
  return reserve_outputs(arguments, {files.radiation, files.sound, files.picture, files.wav});
}

scene::Scene read_sounding_scene(const std::string& file)
{
  scene::Scene scene = scene::read_meshed_scene(file);
  if (!scene.sound)
    throw Error(fmt::format("{}: there is no table [sound], so nothing to do", scene.path));
  return scene;
}

/// The results of squeal, which are those of the scene as it is.
squeal::SquealResults read_results_of(const scene::Scene& scene, const SoundFiles& files,
                                      const SceneArguments& arguments)
{
  const files::Reader reader(files.squeal.string());
  const auto origin = mbs_export::file_parts::read_provenance(reader);
  report::require_of_scene(scene,
                           {.file = files.squeal, .what = report::Made::results, .origin = origin},
                           stale_of(arguments));
  return squeal::read_results(reader);
}

void compute_sound(const ChladniArguments& arguments)
{
  report::PhaseClock clock;
  const scene::Scene scene = read_sounding_scene(arguments.scene.scene);
  const SoundFiles files = sound_files(scene, arguments.scene);
  const bool whole = !arguments.sound.radiation_only;
  need(files.body, fmt::format("make it with `chladni run {} --output {}`", arguments.scene.scene,
                               arguments.scene.output));
  if (whole) {
    need(files.squeal, fmt::format("make it with `squeal run {} --output {}`, or ask for the "
                                   "radiation of the modes alone with --radiation",
                                   arguments.scene.scene, arguments.scene.output));
  }
  const mbs_export::ModalBody body = read_body_of(scene, arguments.scene);
  const squeal::SquealResults squeal_results =
      whole ? read_results_of(scene, files, arguments.scene) : squeal::SquealResults{};
  const ReservedOutputs reserved = reserve(arguments.scene, files, arguments.sound);
  clock.end_phase("read");
  const sound::Setting setting{body, *scene.squeal, *scene.sound, scene.radiation};
  report::ProgressLine line;
  report::WholeProgress progress_of_all(
      {{"radiation", 30.0}, {"feedback", 5.0}, {"sound", 45.0}, {"levels over the speed", 20.0}});
  const mbs_export::Provenance origin = origin_of(scene, arguments.scene, body);
  const sound::StudyListener listener{
      .progress = [&](const std::string& step,
                      double part) { line.show(step, progress_of_all.at(step, part)); },
      .found = [&](const sound::SoundResults& found) { write_found(scene, files, found, origin); }};
  const sound::SoundResults results =
      whole ? sound_study(setting, squeal_results, listener)
            : radiation_study(setting, sound::speed_of(*scene.squeal), listener);
  clock.end_phase("sound");

  if (whole) write_found(scene, files, results, origin);
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());
  fmt::print("{}\n\n{}\n{}\nwrote {}\n", report::printable(scene.title),
             report::describe_sound(results), report::format_table(report::cost_table(cost)),
             files.radiation.string());
  if (whole) {
    fmt::print("wrote {}\nwrote {}\n", files.sound.string(), files.picture.string());
    write_wav(scene, files.wav, results, sound::onset_of(squeal_results, scene.sound->cycle));
  }
  write_summary(arguments.scene, report::sound_json(results), cost);
}

}  // namespace

void sound_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { compute_sound(arguments); });
}

}  // namespace chladni::cli
