#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cli/scene/read_tables.hpp"

namespace chladni::cli {
namespace {

/// The groups that the generator of the annulus makes besides its rings.
const std::vector<std::string> annulus_groups = {"disc", "inner_edge", "outer_edge"};

int read_element_order(const Table& mesh)
{
  const int order = mesh.integer("element_order", {.unit = "1, 2 or 3"});
  if (order < 1 || order > 3) {
    mesh.refuse("element_order", "elements of order 1, 2 and 3 are available");
  }
  return order;
}

mesh::RingOptions read_ring(const Table& ring, const Admissible& radii)
{
  return {.name = ring.text("name"),
          .radius = ring.number("radius", radii),
          .nodes = ring.integer("nodes", {.at_least = 3})};
}

std::vector<mesh::RingOptions> read_rings(const Table& mesh, const Admissible& radii)
{
  std::set<std::string> taken(annulus_groups.begin(), annulus_groups.end());
  std::set<double> radii_taken;
  std::vector<mesh::RingOptions> rings;
  if (!mesh.has("rings")) return rings;
  for (const Table& table : mesh.tables("rings")) {
    const mesh::RingOptions ring = read_ring(table, radii);
    if (!taken.insert(ring.name).second) {
      table.refuse("name", "is the name of another ring or group of the mesh");
    }
    if (!radii_taken.insert(ring.radius).second) {
      table.refuse("radius", "is the radius of another ring");
    }
    rings.push_back(ring);
  }
  return rings;
}

mesh::AnnulusOptions read_annulus(const Table& mesh)
{
  mesh.choice<int>("generator", {{"annulus", 0}});
  mesh::AnnulusOptions annulus{};
  annulus.inner_radius = mesh.number("inner_radius", {.above = 0.0, .unit = "m"});
  annulus.outer_radius =
      mesh.number("outer_radius", {.above = annulus.inner_radius, .unit = "m, the inner radius"});
  const double width = annulus.outer_radius - annulus.inner_radius;
  annulus.element_size =
      mesh.number("element_size", {.above = 0.0, .at_most = width, .unit = "m, up to the width"});
  if (mesh.has("element_order")) annulus.element_order = read_element_order(mesh);
  annulus.rings = read_rings(mesh, {.above = annulus.inner_radius,
                                    .below = annulus.outer_radius,
                                    .unit = "m, between the edges of the annulus"});
  return annulus;
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

mesh::MeshOptions read_mesh(const Table& root, const std::string& scene_path)
{
  const Table mesh = root.table("mesh");
  mesh::MeshOptions options;
  if (mesh.only_one_of({"generator", "file"}) == "generator") {
    options.annulus = read_annulus(mesh);
    return options;
  }
  options.file = read_file_name(mesh, scene_path);
  if (mesh.has("element_order")) {
    options.element_order = read_element_order(mesh);
    if (options.file->ends_with(".msh")) {
      mesh.refuse("element_order", "a .msh file has its own order; take this key out");
    }
  }
  options.rings = read_rings(mesh, {.above = 0.0, .unit = "m"});
  return options;
}

std::vector<std::string> ring_names(const mesh::MeshOptions& mesh)
{
  std::vector<std::string> names;
  for (const mesh::RingOptions& ring : mesh.annulus ? mesh.annulus->rings : mesh.rings) {
    names.push_back(ring.name);
  }
  return names;
}

std::vector<std::string> group_names(const mesh::MeshOptions& mesh)
{
  if (!mesh.annulus) return {};
  std::vector<std::string> names = annulus_groups;
  const std::vector<std::string> rings = ring_names(mesh);
  names.insert(names.end(), rings.begin(), rings.end());
  return names;
}

std::vector<std::string> surface_groups(const mesh::MeshOptions& mesh)
{
  return mesh.annulus ? std::vector<std::string>{"disc"} : std::vector<std::string>{};
}

}  // namespace chladni::cli
