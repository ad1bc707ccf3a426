#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::report {

/// How a group of a mesh is shown.
enum class GroupKind {
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

}  // namespace chladni::report
