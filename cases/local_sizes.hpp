#pragma once

#include <vector>

#include "cases/mesh_errors.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::cases {

/// Sizes of elements at places, and how many elements of that size fill the body.
struct LocalSizes {
  std::vector<mesh::SizeAt> sizes;
  double n_elements;
};

/// The sizes with which fewest elements have an error: the error of an element is taken to fall
/// with a power of its size.
/// @param shares     of the mesh as it is
/// @param reduction  the wanted error, as a part of that of the mesh
/// @param rate       that power
/// @return sizes between a tenth and 1.4 times of those of the mesh
LocalSizes local_sizes(const std::vector<ErrorShare>& shares, double reduction, double rate);

/// The number of elements of a mesh with these sizes.
double n_elements(const std::vector<ErrorShare>& shares);

}  // namespace chladni::cases
