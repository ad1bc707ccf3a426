#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/coincident_nodes.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh_reader.hpp"
#include "mesh/quality.hpp"
#include "mesh/rings.hpp"

namespace chladni::mesh {

namespace {

Mesh read(const MeshOptions& options)
{
  return options.trust == Trust::owner ? read_here(options, [] {}) : read_confined(options);
}

}  // namespace

Mesh read_gmsh(const MeshOptions& options)
{
  const std::string& file = options.file.value();
  try {
    Mesh mesh =
        treat_coincident_nodes(read(options), options.coincident_nodes, options.merge_tolerance);
    add_rings(mesh, options.rings);
    return mesh;
  } catch (const Error& e) {
    const std::string text = e.what();
    throw Error(text.find(file) == std::string::npos ? fmt::format("mesh file {}: {}", file, text)
                                                     : text);
  }
}

Mesh draft(const MeshOptions& options)
{
  if (options.annulus) return annulus(*options.annulus);
  if (options.hat_disc) return hat_disc(*options.hat_disc);
  if (options.pad) return pad(*options.pad);
  if (options.rectangle) return rectangle(*options.rectangle);
  if (options.beam) return beam(*options.beam);
  return read_gmsh(options);
}

Mesh generate(const MeshOptions& options)
{
  Mesh mesh = draft(options);
  check_usable(mesh, options.file ? fmt::format("mesh file {}", *options.file) : "the mesh");
  return mesh;
}

}  // namespace chladni::mesh
