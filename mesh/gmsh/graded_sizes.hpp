#pragma once

#include <array>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Sizes of elements that grow with the distance from places of small ones.
class GradedSizes {
 public:
  /// @param places  with the largest size of elements there; at least one
  explicit GradedSizes(std::vector<SizeAt> places);

  /// The largest size at a point: the least of the size at a place and what it may grow by on the
  /// way.
  double at(const std::array<double, 3>& x) const;

 private:
  std::vector<SizeAt> places_;  ///< ascending by the first coordinate
  double smallest_;             ///< m, of the sizes
};

/// Makes the elements of the open model of Gmsh no larger than the options allow at their places.
/// What the model says itself still holds where it is smaller.
/// @param unit  of the model, m
void set_local_sizes(const MeshOptions& options, double unit);

}  // namespace chladni::mesh
