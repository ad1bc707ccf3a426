#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Measures of the shape of one element; 1, 1, 0, 0 is the best.
struct ElementQuality {
  std::int64_t number;
  double scaled_jacobian;  ///< least sine of the angle between its tangents (that of the
                           ///< equilateral triangle counts 1) at its nodes; <= 0 where it is folded
                           ///< over, there or at an integration point
  /// Ratio of the lines between the middles of opposite edges; of a triangle longest edge over
  /// shortest height, scaled to 1 for the equilateral one.
  double aspect_ratio;
  double warp;  ///< deg, between the normals of the two triangles of a quadrilateral's corners
  double skew;  ///< equiangle skewness of the corners, 0 to 1
};

/// The quality of all elements, block by block.
/// Source: Knupp et al., The Verdict Geometric Quality Library, Sandia SAND2007-1751 (scaled
/// Jacobian at the nodes of the element's own order).
std::vector<ElementQuality> quality(const Mesh& mesh);

/// The numbers of the elements whose Jacobian is not positive at each of their nodes and
/// integration points.
std::vector<std::int64_t> unusable(const std::vector<ElementQuality>& elements);

/// Two surface elements that lie on one another.
struct Overlap {
  std::int64_t first, second;  ///< their numbers
};

/// The pairs of elements that lie on one another, each once. These are neighbours between which the
/// surface turns back by more than 179 degrees at their edge, as where one of them is turned over;
/// by more than 150 degrees at all edges of a few elements amid many others, as on a curved
/// surface; and elements of a flat group of which one has a point of the other inside. Elements
/// with the same nodes do not count.
std::vector<Overlap> overlaps(const Mesh& mesh);

/// What is wrong with the elements of a mesh, with the numbers of the first ten; empty if all can
/// be used and none lies on another.
std::string complaint_about(const Mesh& mesh);

/// Checks that there is no complaint about the elements.
/// @param name  of the mesh, for the message
/// @throws chladni::Error with the complaint.
void check_usable(const Mesh& mesh, const std::string& name);

}  // namespace chladni::mesh
