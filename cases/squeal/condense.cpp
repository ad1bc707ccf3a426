#include "cases/squeal/condense.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numbers>
#include <utility>
#include <variant>

#include "cases/squeal/squeal_case.hpp"
#include "common/error.hpp"
#include "mbs_export/files/body_files.hpp"

namespace chladni::cases {
namespace {

using std::filesystem::path;

const squeal::AssemblyOptions& assembly_of(const scene::Scene& scene)
{
  if (scene.squeal_model)
    if (const auto* options = std::get_if<squeal::AssemblyOptions>(&scene.squeal_model->model))
      return *options;
  throw Error(
      fmt::format("{}: there are no bodies of an assembly to condense; give squeal.model = "
                  "\"assembly\" with [[part]], [[joint]] and [[contact]]",
                  scene.path));
}

/// The scene file of a body, as seen from another folder than that of the body's file.
std::string scene_file_from(const path& folder, const path& body_file,
                            const mbs_export::ModalBody& body)
{
  if (body.provenance.scene_file.empty()) return {};
  const path scene = body_file.parent_path() / body.provenance.scene_file;
  return std::filesystem::relative(scene, folder).generic_string();
}

/// What was condensed would be lost, and what is small already has errors that nobody would see.
void refuse_condensed(const scene::Scene& scene, const std::vector<path>& sources,
                      const std::vector<path>& condensed)
{
  for (std::size_t i = 0; i < sources.size(); ++i)
    for (const path& file : condensed)
      if (std::filesystem::weakly_canonical(sources[i]) ==
          std::filesystem::weakly_canonical(file)) {
        throw Error(
            fmt::format("{}: part[{}].body: {} is a condensed body, which would be written "
                        "over; name the large body that it was made of",
                        scene.path, i + 1, sources[i].string()));
      }
}

squeal::CondensedBodies condensed_bodies(const scene::Scene& scene,
                                         const std::vector<mbs_export::ModalBody>& bodies,
                                         const CondenseRequest& request)
{
  const squeal::SpeedRange& speeds = study_of(scene).speeds;
  try {
    return squeal::condense(assembly_of(scene), bodies,
                            {.tolerance = request.tolerance,
                             .highest = 2.0 * std::numbers::pi * request.up_to_Hz,
                             .speed_from = speeds.from,
                             .speed_to = speeds.to,
                             .brake = scene.title});
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", scene.path, error.what()));
  }
}

}  // namespace

std::vector<path> condensed_files(const scene::Scene& scene, const SquealFiles& files)
{
  std::vector<path> condensed;
  for (const squeal::PartOptions& part : assembly_of(scene).parts)
    condensed.push_back(files.folder / (scene.name + ".condensed") / (part.name + ".body.h5"));
  return condensed;
}

CondensedBrake condensed_brake(const scene::Scene& scene, const SquealFiles& files,
                               StaleChoice stale, const CondenseRequest& request)
{
  const squeal::AssemblyOptions& options = assembly_of(scene);
  const std::vector<path> sources = part_files(*scene.squeal_model, files);
  std::vector<path> condensed = condensed_files(scene, files);
  refuse_condensed(scene, sources, condensed);
  const std::vector<mbs_export::ModalBody> bodies = part_bodies(scene, files, stale);
  CondensedBrake brake{.parts = {}, .found = condensed_bodies(scene, bodies, request)};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    mbs_export::ModalBody& body = brake.found.bodies[i];
    body.provenance.scene_file = scene_file_from(condensed[i].parent_path(), sources[i], bodies[i]);
    brake.parts.push_back(
        {options.parts[i].name, std::move(condensed[i]), bodies[i].n_modes(), body.n_modes()});
  }
  return brake;
}

void write(const CondensedBrake& brake)
{
  for (std::size_t i = 0; i < brake.parts.size(); ++i)
    mbs_export::write_body(brake.parts[i].file.string(), brake.found.bodies[i]);
}

}  // namespace chladni::cases
