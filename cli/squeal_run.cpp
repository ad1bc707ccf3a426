#include "cli/squeal_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "cli/reserve_outputs.hpp"
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
#include "report/squeal_json.hpp"
#include "report/timing.hpp"
#include "report/version.hpp"
#include "scene/scene.hpp"
#include "squeal/disc.hpp"
#include "squeal/model_run.hpp"
#include "squeal/radiation.hpp"
#include "squeal/result_file.hpp"
#include "squeal/run.hpp"
#include "squeal/wav_file.hpp"

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

/// What the analyses found, and where the numbers come from.
struct Performed {
  squeal::SquealResults results;
  mbs_export::Provenance origin;
};

/// The analyses of a disc that is this body, damped by `radiation` if the scene says so.
Performed perform_on_body(const scene::Scene& scene, const mbs_export::ModalBody& body,
                          const RadiationFile& radiation, report::PhaseClock& clock)
{
  squeal::Disc disc =
      squeal::make_disc(body, squeal::ring_names(*scene.squeal), scene.squeal->modes);
  if (scene.radiation)
    disc = squeal::with_radiation(std::move(disc), read_radiation_of(radiation, scene));
  clock.end_phase("read");
  report::ProgressLine line;
  Performed performed{squeal::run(disc, *scene.squeal,
                                  [&](const std::string& analysis, double fraction) {
                                    line.show(analysis, fraction);
                                  }),
                      body.provenance};
  performed.origin.body_scene = std::exchange(performed.origin.scene, scene.text);
  performed.origin.versions =
      fmt::format("squeal {}; body: {}", report::version, performed.origin.versions);
  return performed;
}

/// The analyses of a model that needs no body.
Performed perform_on_model(const scene::Scene& scene)
{
  report::ProgressLine line;
  Performed performed{
      squeal::run(*scene.squeal_model, [&](const std::string& analysis,
                                           double fraction) { line.show(analysis, fraction); }),
      {}};
  performed.origin.scene = scene.text;
  performed.origin.versions = fmt::format("squeal {}", report::version);
  performed.origin.ranks = 1;
  return performed;
}

struct Files {
  path body, radiation;  ///< read
  path results, sound;   ///< written
};

Files files_of(const scene::Scene& scene, const path& folder, const path& body)
{
  const auto with = [&](const char* extension) { return folder / (scene.name + extension); };
  return {.body = body.empty() ? with(".body.h5") : body,
          .radiation = with(".radiation.h5"),
          .results = with(".squeal.h5"),
          .sound = with(".wav")};
}

/// The sound, when the scene asks for it.
void write_sound(const scene::Scene& scene, const path& file, const squeal::SquealResults& results)
{
  if (!scene.squeal || !scene.squeal->sound || !results.transient) return;
  const double scale =
      squeal::write_wav(file, results.transient->sound, scene.squeal->sound->rate_Hz);
  fmt::print("wrote {}, full scale {:.6g} m/s\n", file.string(), scale);
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

}  // namespace

void run_squeal(const SceneArguments& arguments, const std::string& body_file)
{
  report::PhaseClock clock;
  const scene::Scene scene = scene::read_scene(arguments.scene);
  if (!scene.squeal && !scene.squeal_model) {
    throw Error(fmt::format("{}: there is no table [squeal], so nothing to do", scene.path));
  }
  if (scene.squeal_model && !body_file.empty()) {
    throw Error(fmt::format("{}: squeal.model needs no body; leave out --body", scene.path));
  }
  tell_notes(scene);
  const Files files = files_of(scene, arguments.output, body_file);
  std::optional<mbs_export::ModalBody> body;
  if (!scene.squeal_model) body = read_body_of(files.body, arguments);
  if (body && body_file.empty()) require_of_scene(scene, files.body, *body, arguments);
  const ReservedOutputs reserved = reserve_outputs(arguments, {files.results, files.sound});
  RadiationFile radiation{.file = files.radiation, .stale = {}};
  if (body_file.empty()) radiation.stale = stale_of(arguments);
  auto [results, origin] =
      body ? perform_on_body(scene, *body, radiation, clock) : perform_on_model(scene);
  origin.scene_file = scene_file_of(arguments);
  clock.end_phase("analyses");

  squeal::write_results(files.results, results, origin);
  clock.end_phase("write");
  const report::Cost cost = report::cost_so_far(clock.phases());

  fmt::print("{}\n\n{}\n{}\nwrote {}\n", report::printable(scene.title),
             report::format_table(report::describe(results)),
             report::format_table(report::cost_table(cost)), files.results.string());
  write_sound(scene, files.sound, results);
  if (!arguments.json.empty()) write_json(arguments.json, results, cost);
  if (results.failure) throw Error(*results.failure);
}

}  // namespace chladni::cli
