#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cli/scene/read_mesh_parts.hpp"

namespace chladni::cli {
namespace {

mesh::RingOptions read_ring(const Table& ring, const Admissible& radii)
{
  mesh::RingOptions options{.name = ring.text("name"),
                            .radius = ring.number("radius", radii),
                            .nodes = ring.integer("nodes", {.at_least = 3})};
  if (ring.has("z")) options.z = ring.number("z", {.unit = "m"});
  return options;
}

std::string read_file_name(const Table& mesh, const std::string& scene_path)
{
  const std::filesystem::path file = mesh.text("file");
  const std::string extension = file.extension().string();
  if (extension == ".step" || extension == ".stp") {
    mesh.refuse("file", "STEP files are not available yet; give a .msh or a .geo file");
  }
  if (extension != ".msh" && extension != ".geo") {
    mesh.refuse("file", "must be a .msh or a .geo file");
  }
  return (std::filesystem::path(scene_path).parent_path() / file).lexically_normal().string();
}

}  // namespace

int read_element_order(const Table& mesh)
{
  return mesh.integer("element_order", {.at_least = 1, .at_most = 4});
}

std::vector<mesh::RingOptions> read_rings(const Table& mesh, const std::vector<std::string>& taken,
                                          const Admissible& radii)
{
  std::set<std::string> names(taken.begin(), taken.end());
  std::set<std::pair<double, std::optional<double>>> circles;
  std::vector<mesh::RingOptions> rings;
  if (!mesh.has("rings")) return rings;
  for (const Table& table : mesh.tables("rings")) {
    const mesh::RingOptions ring = read_ring(table, radii);
    if (!names.insert(ring.name).second) {
      table.refuse("name", "is the name of another ring or group of the mesh");
    }
    if (!circles.insert({ring.radius, ring.z}).second) {
      table.refuse("radius", "is the radius of another ring");
    }
    rings.push_back(ring);
  }
  return rings;
}

mesh::MeshOptions read_mesh(const Table& root, const std::string& scene_path)
{
  const Table mesh = root.table("mesh");
  if (mesh.only_one_of({"generator", "file"}) == "generator") return read_generator(mesh);
  mesh::MeshOptions options;
  options.file = read_file_name(mesh, scene_path);
  if (mesh.has("element_order")) {
    options.element_order = read_element_order(mesh);
    if (options.file->ends_with(".msh")) {
      mesh.refuse("element_order", "a .msh file has its own order; take this key out");
    }
  }
  options.rings = read_rings(mesh, {}, {.above = 0.0, .unit = "m"});
  return options;
}

std::vector<std::string> ring_names(const mesh::MeshOptions& mesh)
{
  const auto& rings = mesh.annulus    ? mesh.annulus->rings
                      : mesh.hat_disc ? mesh.hat_disc->rings
                                      : mesh.rings;
  std::vector<std::string> names;
  for (const mesh::RingOptions& ring : rings) names.push_back(ring.name);
  return names;
}

std::vector<std::string> group_names(const mesh::MeshOptions& mesh)
{
  std::vector<std::string> names = generated_groups(mesh);
  if (names.empty()) return {};
  const std::vector<std::string> rings = ring_names(mesh);
  names.insert(names.end(), rings.begin(), rings.end());
  return names;
}

}  // namespace chladni::cli
