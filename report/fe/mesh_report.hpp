#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/quality.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"

namespace chladni::report {

/// How a group of a mesh is shown.
enum class GroupKind {
  volume,   ///< of solids
  surface,  ///< the group's elements
  lines,    ///< the group's beam elements
  curve,    ///< element edges between the group's nodes
  points    ///< the group's nodes only
};

/// "surface", "lines", "curve" or "points"
std::string name_of(GroupKind kind);

/// The drawable parts of a group.
struct GroupParts {
  GroupKind kind;
  std::vector<std::vector<int>> edges;  ///< node lists along the edges of a curve or of lines
  std::vector<int> points;  ///< the group's nodes that are on none of its elements and edges
  double size = 0.0;  ///< area in m^2 of a surface, length in m of a curve or lines; 0 if unknown
  /// Smallest and largest x, y, z, m; 0 if the group is empty.
  std::array<std::array<double, 2>, 3> extents = {};
};

/// The parts of each group of the mesh.
std::vector<GroupParts> group_parts(const mesh::Mesh& mesh);

/// Level of detail of a drawn mesh.
enum class Detail {
  lattice,  ///< all lattice nodes, so that curved elements look curved
  corners,  ///< the corners of each element
  clusters  ///< nearby corners merged into one
};

/// A group as drawn on the page, by indices into MeshDrawing::positions.
struct GroupDrawing {
  std::vector<std::int32_t> lines;  ///< two end points per line
  std::vector<std::int32_t> points;
};

/// A mesh as it is drawn on a page.
struct MeshDrawing {
  Detail detail = Detail::lattice;
  std::vector<float> positions;  ///< [3 n] m
  /// [4 n_cells] corners; a triangle repeats its last corner, a line repeats both of its ends.
  std::vector<std::int32_t> cells;
  std::vector<std::int32_t> group_of_cell;  ///< [n_cells] -1 for none
  std::vector<std::int32_t> edges;          ///< two end points per element edge; empty for clusters
  std::vector<GroupDrawing> groups;
};

/// Largest numbers of cells for a drawing with all lattice nodes and for one with the corners.
struct DrawingLimits {
  std::size_t lattice = 60'000;
  std::size_t corners = 100'000;
};

/// The most detailed drawing within the limits; clusters are merged until they fit.
/// @param parts  of the groups of the mesh, from group_parts
MeshDrawing draw_mesh(const mesh::Mesh& mesh, std::span<const GroupParts> parts,
                      const DrawingLimits& limits = {});

/// The mesh as an HTML page in which it can be turned, with a list of the groups that shows where
/// each is. The page is one file and loads nothing else. A large mesh is drawn coarser, and the
/// page says so.
/// @param parts    of the groups of the mesh, from group_parts
/// @param summary  table for the end of the page
std::string mesh_page(const std::string& title, const mesh::Mesh& mesh,
                      const std::vector<GroupParts>& parts, const TextTable& summary);

/// A table with the numbers of nodes, of elements of each kind and of nodes in each group.
TextTable mesh_table(const mesh::Mesh& mesh);

/// JSON members `n_nodes`, `n_elements`, `mesh_checksum` and `notes`.
std::vector<Json::Member> mesh_json(const mesh::Mesh& mesh);

}  // namespace chladni::report

/// Element quality of a mesh, as text and as JSON.

namespace chladni::report {

/// Minimum, mean, maximum and histogram of each quality measure, and the first ten unusable
/// elements.
std::string quality_text(const std::vector<mesh::ElementQuality>& elements);

/// JSON members `quality`, with min, mean, max, bin_edges and counts of each measure, and
/// `unusable_elements` with their numbers.
std::vector<Json::Member> quality_json(const std::vector<mesh::ElementQuality>& elements);

}  // namespace chladni::report
