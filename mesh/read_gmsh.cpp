#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <filesystem>

#include "common/error.hpp"
#include "mesh/generate.hpp"
#include "mesh/gmsh_model.hpp"
#include "mesh/rings.hpp"

namespace chladni::mesh {

namespace {

void check_readable(const std::string& file)
{
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(fmt::format("mesh file {} does not exist; give the path of a .msh or .geo", file));
  }
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".msh" && extension != ".geo") {
    throw Error(fmt::format("mesh file {}: only .msh and .geo files can be read", file));
  }
}

void check_orders(const Mesh& mesh, const std::string& file)
{
  for (const ElementBlock& block : mesh.blocks) {
    if (block.shape == Shape::line || (block.order >= 1 && block.order <= 4)) continue;
    throw Error(fmt::format("mesh file {} has elements of order {}; use 1 to 4 (Mesh.ElementOrder)",
                            file, block.order));
  }
}

}  // namespace

Mesh read_gmsh(const MeshOptions& options)
{
  const std::string& file = options.file.value();
  check_readable(file);
  const bool geometry = std::filesystem::path(file).extension() == ".geo";
  const int order = geometry ? options.element_order.value_or(3) : 0;
  try {
    Mesh mesh = mesh_with_gmsh([&] { gmsh::open(file); }, order, options.line_groups);
    check_orders(mesh, file);
    add_rings(mesh, options.rings);
    return mesh;
  } catch (const Error& e) {
    const std::string text = e.what();
    throw Error(text.find(file) == std::string::npos ? fmt::format("mesh file {}: {}", file, text)
                                                     : text);
  }
}

Mesh generate(const MeshOptions& options)
{
  if (options.annulus) return annulus(*options.annulus);
  if (options.hat_disc) return hat_disc(*options.hat_disc);
  if (options.pad) return pad(*options.pad);
  if (options.rectangle) return rectangle(*options.rectangle);
  if (options.beam) return beam(*options.beam);
  return read_gmsh(options);
}

}  // namespace chladni::mesh
