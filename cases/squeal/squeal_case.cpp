#include "cases/squeal/squeal_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/input_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/version.hpp"
#include "scene/scene_text.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/models/assembly_brake.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::cases {

using std::filesystem::path;

namespace {

squeal::Radiation read_radiation_of(const scene::Scene& scene, const SquealFiles& files,
                                    StaleChoice stale)
{
  const path& file = files.radiation;
  if (!std::filesystem::exists(file)) {
    throw Error(
        fmt::format("{0}: no such file, but squeal.radiation = true needs it; make it with "
                    "`chladni sound {1} --radiation --output {2}`",
                    file.string(), scene.path, file.parent_path().string()));
  }
  const files::Reader reader(file.string());
  squeal::Radiation radiation = squeal::read_radiation(reader);
  if (!stale || !reader.contains("provenance/scene")) return radiation;
  const auto origin = mbs_export::file_parts::read_provenance(reader);
  report::require_of_scene(scene, {.file = file, .what = report::Made::radiation, .origin = origin},
                           *stale);
  return radiation;
}

/// Digests of the files that a run reads, and the version of the program: RunOrigin::inputs.
/// @param body, radiation  empty for none
/// @param parts            of an assembly
std::string inputs_of(const path& body, const path& radiation, const std::vector<path>& parts)
{
  std::string inputs = fmt::format("squeal {}", report::version);
  if (!body.empty()) inputs += fmt::format(", body {}", files::file_digest(body.string()));
  if (!radiation.empty())
    inputs += fmt::format(", radiation {}", files::file_digest(radiation.string()));
  for (const path& part : parts)
    inputs += fmt::format(", part {}", files::file_digest(part.string()));
  return inputs;
}

}  // namespace

SquealFiles squeal_files(const scene::Scene& scene, const path& folder, const path& body)
{
  const auto with = [&](const char* extension) { return folder / (scene.name + extension); };
  return {.folder = folder,
          .body = body.empty() ? with(".body.h5") : body,
          .radiation = with(".radiation.h5"),
          .results = with(".squeal.h5"),
          .sound = with(".wav")};
}

void require_study(const scene::Scene& scene)
{
  if (!scene.squeal && !scene.squeal_model)
    throw Error(fmt::format("{}: there is no table [squeal], so nothing to do", scene.path));
}

std::optional<mbs_export::ModalBody> body_for_squeal(const scene::Scene& scene,
                                                     const SquealFiles& files, StaleChoice stale)
{
  if (scene.squeal_model) return std::nullopt;
  if (!std::filesystem::exists(files.body)) {
    throw Error(
        fmt::format("{}: no such file; make it with `chladni run {} --output {}`, or name "
                    "another one with --body",
                    files.body.string(), scene.path, files.folder.string()));
  }
  mbs_export::ModalBody body = mbs_export::read_body(files.body);
  if (stale) {
    report::require_of_scene(
        scene, {.file = files.body, .what = report::Made::body, .origin = body.provenance}, *stale);
  }
  return body;
}

namespace {

/// What bodies have but no brake uses.
void add_note_of_stiffening(std::span<const mbs_export::ModalBody> bodies,
                            std::vector<std::string>& notes)
{
  const auto is_stiffened = [](const mbs_export::ModalBody& body) {
    return body.stiffening.has_value();
  };
  if (std::ranges::none_of(bodies, is_stiffened)) return;
  notes.emplace_back(
      "the geometric stiffening (reduce.stiffening) is not used: in a brake a body has its "
      "stiffness at rest");
}

/// Up to where condensed bodies are those of their brake.
void add_note_of_condensation(std::span<const mbs_export::ModalBody> bodies,
                              std::vector<std::string>& notes)
{
  double lowest = std::numeric_limits<double>::infinity();
  for (const mbs_export::ModalBody& body : bodies)
    if (body.condensation) lowest = std::min(lowest, body.condensation->highest);
  if (lowest == std::numeric_limits<double>::infinity()) return;
  notes.push_back(
      fmt::format("condensed bodies have the vibrations of their brake up to {:.6g} Hz; results "
                  "above it are not those of the brake",
                  lowest / (2.0 * std::numbers::pi)));
}

/// A brake without a mesh: a few equations, or bodies of other scenes.
SquealCase model_case(const scene::Scene& scene, const SquealFiles& files, StaleChoice stale)
{
  const squeal::ModelOptions& model = scene.squeal_model.value();
  SquealCase made;
  const std::vector<mbs_export::ModalBody> bodies = part_bodies(scene, files, stale);
  if (bodies.empty()) return {.brake = squeal::model_brake(model), .notes = {}};
  try {
    made.brake = squeal::model_brake(model, bodies);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", scene.path, error.what()));
  }
  made.notes = dynamic_cast<const squeal::AssemblyBrake&>(*made.brake).assembly().notes;
  add_note_of_stiffening(bodies, made.notes);
  add_note_of_condensation(bodies, made.notes);
  return made;
}

/// What the modes that a scene leaves out would change: the brake with all of them.
std::shared_ptr<const squeal::FlexibleDisc> complete_disc(const mbs_export::ModalBody& body,
                                                          const squeal::SquealOptions& options)
{
  if (!options.modes.nodal_diameters && !options.modes.list) return nullptr;
  return std::make_shared<const squeal::FlexibleDisc>(
      squeal::make_disc(body, squeal::ring_choice(options), {}), options);
}

/// Pads whose size nobody gave, where errors are told.
std::optional<std::string> note_of_points(const squeal::FlexibleDisc& brake)
{
  if (brake.disc().errors.mesh.size() == 0) return std::nullopt;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < brake.options().pads.size(); ++i)
    if (squeal::lacks_a_size(brake.options().pads[i])) numbers.push_back(i + 1);
  if (numbers.empty()) return std::nullopt;
  return fmt::format(
      "squeal.pads: number {} gives no size and touches the disc at a point, whose displacement no "
      "mesh gets right: growth rates and critical speeds change further with finer elements, and "
      "their errors contain this; give `radius` or `area`, or face = \"point\" if a point is meant",
      fmt::join(numbers, ", "));
}

/// A disc whose stability is that of periodic equations.
std::optional<std::string> note_of_asymmetry(const squeal::FlexibleDisc& brake)
{
  if (brake.is_autonomous() || brake.options().keeps_asymmetry) return std::nullopt;
  return fmt::format(
      "the disc is not axisymmetric: {}; its stability is computed by Hill's method over a "
      "rotation, without errors of the body; this takes long with many modes",
      squeal::asymmetry(brake.disc()).value_or("as it is"));
}

/// Modes that count as pure harmonics, as far as their errors let them be.
std::optional<std::string> note_of_impurity(const squeal::FlexibleDisc& brake)
{
  if (!brake.is_autonomous()) return std::nullopt;
  const squeal::InertialDisc& disc = brake.inertial();
  if (!(disc.explained_impurity > squeal::impurity_limit)) return std::nullopt;
  return fmt::format(
      "mode shapes differ from pure harmonics by up to {:.2g}, which the errors of their "
      "frequencies explain; the disc is taken as axisymmetric",
      disc.explained_impurity);
}

/// What the mean over the circumference takes from pairs whose modes decay differently.
std::optional<std::string> note_of_damping(const squeal::FlexibleDisc& brake)
{
  if (!brake.is_autonomous()) return std::nullopt;
  const squeal::InertialDisc& disc = brake.inertial();
  // One ratio for both differs as their frequencies do.
  constexpr double worth_telling = 1e-3;
  if (!(disc.damping_contrast > worth_telling + 2.0 * disc.largest_split)) return std::nullopt;
  return fmt::format(
      "the two modes of a pair decay at rates that differ by up to {:.3g} 1/s; the inertial frame "
      "takes their mean, so that a growth rate may lack up to half of that; squeal.asymmetry = "
      "\"kept\" keeps them, with the analyses \"stability\", \"critical-speed\" and "
      "\"rotation-stability\"",
      disc.damping_spread);
}

}  // namespace

SquealCase squeal_case(const scene::Scene& scene, const std::optional<mbs_export::ModalBody>& body,
                       const SquealFiles& files, StaleChoice stale)
{
  if (!body) return model_case(scene, files, stale);
  const squeal::SquealOptions& options = scene.squeal.value();
  squeal::Disc disc = squeal::make_disc(*body, squeal::ring_choice(options), options.modes);
  squeal::refuse_aliases(disc, *body);
  if (scene.radiation)
    disc = squeal::with_radiation(std::move(disc), read_radiation_of(scene, files, stale));
  std::vector<std::string> notes = squeal::notes_of(disc);
  auto brake = std::make_unique<squeal::FlexibleDisc>(std::move(disc), options,
                                                      complete_disc(*body, options));
  for (const auto& note : {note_of_damping(*brake), note_of_impurity(*brake),
                           note_of_points(*brake), note_of_asymmetry(*brake),
                           squeal::note_of_lacking_errors(brake->disc(), *body, options.modes)})
    if (note) notes.push_back(*note);
  add_note_of_stiffening({&*body, 1}, notes);
  return {.brake = std::move(brake), .notes = std::move(notes)};
}

const squeal::StudyOptions& study_of(const scene::Scene& scene)
{
  return scene.squeal ? scene.squeal->study : scene.squeal_model.value().study;
}

squeal::RunOrigin squeal_origin(const scene::Scene& scene,
                                const std::optional<mbs_export::ModalBody>& body,
                                const SquealFiles& files, const std::string& scene_file)
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
  origin.scene_file = scene_file;
  return {
      std::move(origin),
      inputs_of(body ? files.body : path(), scene.radiation ? files.radiation : path(),
                scene.squeal_model ? part_files(*scene.squeal_model, files) : std::vector<path>())};
}

namespace {

/// Nothing that the body of a part was made from has changed in its own scene, where that is at
/// hand.
void require_of_own_scene(const path& file, const mbs_export::ModalBody& body, report::Stale stale)
{
  if (body.provenance.scene_file.empty()) return;
  const path own = (file.parent_path() / body.provenance.scene_file).lexically_normal();
  if (!std::filesystem::is_regular_file(own)) return;
  try {
    report::require_of_scene(scene::read_scene(own.string()),
                             {.file = file, .what = report::Made::body, .origin = body.provenance},
                             stale);
  } catch (const Error& error) {
    if (!body.condensation) throw;
    throw Error(
        fmt::format("{}; this body is condensed: make the large one anew where it was, then "
                    "run `squeal condense` again",
                    error.what()));
  }
}

}  // namespace

std::vector<path> part_files(const squeal::ModelOptions& model, const SquealFiles& files)
{
  std::vector<path> bodies;
  if (const auto* options = std::get_if<squeal::AssemblyOptions>(&model.model))
    for (const squeal::PartOptions& part : options->parts)
      bodies.push_back(files.folder / part.body);
  return bodies;
}

std::vector<mbs_export::ModalBody> part_bodies(const scene::Scene& scene, const SquealFiles& files,
                                               StaleChoice stale)
{
  std::vector<mbs_export::ModalBody> bodies;
  const std::vector<path> names = part_files(scene.squeal_model.value(), files);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto same = std::ranges::find(names.begin(), names.begin() + std::ptrdiff_t(i), names[i]);
    if (const auto j = same - names.begin(); j < std::ptrdiff_t(i)) {
      bodies.push_back(bodies[static_cast<std::size_t>(j)]);
      continue;
    }
    if (!std::filesystem::exists(names[i])) {
      throw Error(fmt::format(
          "{}: part[{}].body: {}: no such file; make it with `chladni run` of that body's scene "
          "and the same --output",
          scene.path, i + 1, names[i].string()));
    }
    bodies.push_back(mbs_export::read_body(names[i]));
    if (stale) require_of_own_scene(names[i], bodies.back(), *stale);
  }
  return bodies;
}

namespace {

/// Refuses what another run left in `file`.
void require_same(const path& file, const squeal::RunOrigin& then, const squeal::RunOrigin& now)
{
  const std::vector<std::string> changed =
      scene::changed_keys(then.provenance.scene, now.provenance.scene, scene::Step::squeal);
  if (!changed.empty()) {
    throw Error(fmt::format(
        "{}: cannot be resumed, since the scene has changed: {}; --overwrite begins anew",
        file.string(), fmt::join(changed, ", ")));
  }
  if (then.inputs != now.inputs) {
    throw Error(
        fmt::format("{}: cannot be resumed: it was made from {}, and this run has {}; "
                    "--overwrite begins anew",
                    file.string(), then.inputs, now.inputs));
  }
}

}  // namespace

squeal::SquealResults resume(const path& results, const squeal::RunOrigin& origin)
{
  squeal::SquealResults begin;
  if (exists(results)) {
    const files::Reader reader(results.string());
    begin = squeal::read_results(reader);
    if (!begin.missing.empty()) {
      require_same(results, {mbs_export::file_parts::read_provenance(reader), begin.inputs},
                   origin);
      return begin;
    }
  }
  throw Error(fmt::format(
      "--resume: no run was interrupted here: there is no unfinished {}; run without --resume",
      results.string()));
}

squeal::SweepTable resume(const path& file, const squeal::SweepTable& wanted,
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

void require_no_unfinished_sweep(const path& file)
{
  if (!exists(file)) return;
  const files::Reader reader(file.string());
  if (reader.text_attribute("/", "format") != squeal::sweep_format) return;
  const squeal::SweepTable left = squeal::read_sweep(reader);
  if (left.count(squeal::VariantState::to_do) == 0) return;
  throw Error(
      fmt::format("{}: a sweep that was interrupted; --resume goes on from it, --overwrite begins "
                  "anew",
                  file.string()));
}

}  // namespace chladni::cases
