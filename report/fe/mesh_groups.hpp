#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::report {

/// What a group of a mesh is seen as.
enum class GroupKind {
  surface,  ///< its elements
  lines,    ///< its elements, of beams
  curve,    ///< edges of elements between its nodes
  points    ///< its nodes alone
};

/// "surface", "lines", "curve" or "points"
std::string name_of(GroupKind kind);

/// What a group is made of.
struct GroupParts {
  GroupKind kind;
  std::vector<std::vector<int>> edges;  ///< of a curve or of lines: nodes from end to end
  std::vector<int> points;              ///< nodes on none of its elements and edges
  double size = 0.0;  ///< m^2 of a surface, m of a curve or of lines; 0 if unknown
  std::array<std::array<double, 2>, 3> extents = {};  ///< m, least and greatest x, y, z; 0 if empty
};

/// The parts of each group of the mesh.
std::vector<GroupParts> group_parts(const mesh::Mesh& mesh);

}  // namespace chladni::report
