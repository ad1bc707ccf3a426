#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <filesystem>

#include "common/error.hpp"
#include "mesh/coincident_nodes.hpp"
#include "mesh/generators.hpp"
#include "mesh/gmsh_files.hpp"
#include "mesh/gmsh_model.hpp"
#include "mesh/quality.hpp"
#include "mesh/rings.hpp"

namespace chladni::mesh {

namespace {

enum class Format { msh, geo, step };

Format format_of(const std::string& file)
{
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(
        fmt::format("mesh file {} does not exist; give the path of a .msh, .geo or .step", file));
  }
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".msh") return Format::msh;
  if (extension == ".geo") return Format::geo;
  if (extension == ".step" || extension == ".stp") return Format::step;
  throw Error(fmt::format("mesh file {}: only .msh, .geo and .step files can be read", file));
}

/// Opens the file in Gmsh, with its groups.
/// @return notes for the user
std::vector<std::string> open(const MeshOptions& options, Format format)
{
  if (format == Format::step) return open_step(options);
  std::vector<std::string> notes;
  if (format == Format::geo) notes = open_geo(options);
  if (format == Format::msh) gmsh::open(*options.file);
  add_entity_groups(options);
  return notes;
}

/// The mesh as Gmsh gives it, in metres.
Mesh read(const MeshOptions& options)
{
  const Format format = format_of(*options.file);
  if (format == Format::msh) check_msh_is_whole(*options.file);
  const int order = format == Format::msh ? 0 : options.element_order.value_or(3);
  std::vector<std::string> notes;
  Mesh mesh = mesh_with_gmsh([&] { notes = open(options, format); }, order, options.line_groups);
  mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
  const double metres = format == Format::step ? 1e-3 : options.length_unit;
  for (auto& x : mesh.positions) {
    for (double& coordinate : x) coordinate *= metres;
  }
  return mesh;
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
