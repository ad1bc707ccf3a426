#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"

namespace chladni::report {

/// How much of a mesh is drawn.
enum class Detail {
  lattice,  ///< all nodes: curved elements are curved
  corners,  ///< the corners of each element
  clusters  ///< corners near to each other as one
};

/// What a page draws of one group, as places in MeshDrawing::positions.
struct GroupDrawing {
  std::vector<std::int32_t> lines;  ///< two ends each
  std::vector<std::int32_t> points;
};

/// A mesh as it is drawn.
struct MeshDrawing {
  Detail detail = Detail::lattice;
  std::vector<float> positions;             ///< [3 n] m
  std::vector<std::int32_t> cells;          ///< [4 n_cells]; a triangle repeats its last corner, a
                                            ///< line twice
  std::vector<std::int32_t> group_of_cell;  ///< [n_cells] -1 without one
  std::vector<std::int32_t> edges;          ///< two ends each; of the elements, none for clusters
  std::vector<GroupDrawing> groups;
};

/// The most cells that a drawing of all lattice nodes and one of the corners may have.
struct DrawingLimits {
  std::size_t lattice = 60'000;
  std::size_t corners = 100'000;
};

/// The drawing with the most detail that keeps within the limits; clusters always do.
/// @param parts  of the groups
MeshDrawing draw_mesh(const mesh::Mesh& mesh, std::span<const GroupParts> parts,
                      const DrawingLimits& limits = {});

}  // namespace chladni::report
