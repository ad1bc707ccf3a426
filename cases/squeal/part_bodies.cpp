#include "cases/squeal/part_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <variant>

#include "common/error.hpp"
#include "mbs_export/files/body_file.hpp"

namespace chladni::cases {

using std::filesystem::path;

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

}  // namespace chladni::cases
