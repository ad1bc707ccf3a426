#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"

namespace chladni::report {

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

}  // namespace chladni::report
