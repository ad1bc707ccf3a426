#pragma once

#include <filesystem>
#include <string>

#include "mbs_export/reduced_system.hpp"
#include "scene/scene.hpp"

/// Checks whether files belong to the present scene.
namespace chladni::report {

/// The kinds of files that are made from a scene.
enum class Made { reduction, body, results, radiation, sound };

/// A file that was read, with its provenance.
struct Read {
  std::filesystem::path file;
  Made what;
  const mbs_export::Provenance& origin;
};

/// What to do with a file that was made before the scene or its mesh file changed.
enum class Stale { refuse, use };

/// The digests of the bytes of the scene's mesh file and its matrices, one behind the other.
/// @return empty without a mesh file, and if one of them cannot be read
std::string digest_of_mesh_files(const scene::Scene& scene);

/// Checks that a file belongs to the present scene, that is, that nothing it was made from has
/// changed since: the parts of the scene that it and its predecessors depend on, and the mesh file
/// if that exists. A file without a scene (from another program, or of a scene without a body) is
/// accepted.
/// @throws chladni::Error naming the file, the changed keys and the commands that make it anew;
///         with Stale::use this is printed on stderr instead.
void require_of_scene(const scene::Scene& scene, const Read& read, Stale stale);

}  // namespace chladni::report
