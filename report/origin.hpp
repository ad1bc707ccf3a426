#pragma once

#include <filesystem>
#include <string>

#include "mbs_export/reduced_system.hpp"
#include "scene/scene.hpp"

/// Whether files are those of the scene as it is now.
namespace chladni::report {

enum class Made { reduction, body, results, radiation, sound };

/// A file that was read, and what it tells of its making.
struct Read {
  std::filesystem::path file;
  Made what;
  const mbs_export::Provenance& origin;
};

/// What to do with a file that was made when the scene, or its mesh file, was another.
enum class Stale { refuse, use };

/// A file is of the scene when nothing that it was made from has changed since: neither the parts
/// of the scene that it and what went before it depend on, nor the mesh file where that is at hand.
/// A file without a scene (by other programs, or as a scene that says nothing of its body) is left
/// to the user.
/// @throws chladni::Error that names the file, the keys and the programs that make it anew;
///         with Stale::use that is a line on stderr.
void require_of_scene(const scene::Scene& scene, const Read& read, Stale stale);

}  // namespace chladni::report
