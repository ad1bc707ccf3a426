#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Shape of one element; 1, 1, 0, 0 is the best.
struct ElementQuality {
  std::int64_t number;
  double
      scaled_jacobian;  ///< least sine of the angle between its tangents (that of the equilateral
                        ///< triangle counts 1) at its nodes; <= 0 where it is folded over
  double aspect_ratio;  ///< of the lines between the middles of its edges; of a triangle longest
                        ///< edge over shortest height, the equilateral one counts 1
  double warp;          ///< deg, between the normals of the halves of a quadrilateral's corners
  double skew;          ///< equiangle skewness of the corners, 0 to 1
};

/// Of all elements, block by block. Source of the measures: Knupp et al., The Verdict Geometric
/// Quality Library, Sandia SAND2007-1751 (scaled Jacobian at the nodes of the element's own order).
std::vector<ElementQuality> quality(const Mesh& mesh);

/// Numbers of elements that cannot work: their Jacobian is not positive at each of their nodes.
std::vector<std::int64_t> unusable(const std::vector<ElementQuality>& elements);

/// @param name  of the mesh, for the message
/// @throws chladni::Error with the numbers of the first ten elements that cannot work.
void check_usable(const Mesh& mesh, const std::string& name);

}  // namespace chladni::mesh
