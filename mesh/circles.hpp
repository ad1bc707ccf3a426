#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// A circle of Gmsh's model about an axis along z, split into equal arcs that begin on the x side.
struct Circle {
  double radius;              ///< m
  int n_elements;             ///< of each arc
  std::vector<int> points;    ///< tags
  std::vector<int> arcs;      ///< tags
};

/// Where a circle is, and into how many arcs it is cut.
struct CirclePlace {
  double radius;                      ///< m
  std::array<double, 3> centre = {};  ///< m
  int n_arcs = 4;
};

/// A circle of elements of about `size`, at least 12: a cubic edge of 90 degrees folds its element
/// over.
Circle add_circle(const CirclePlace& place, double size);

/// A circle with as many arcs and elements as `like`.
Circle add_circle(const CirclePlace& place, const Circle& like);

/// Rows and columns between two circles that are like each other; across, elements of `size`.
/// @return tags of the surfaces
std::vector<int> add_rows(const Circle& first, const Circle& last, double size);

/// Plane surface between an outer circle and the holes in it.
int add_plane(const Circle& outer, const std::vector<Circle>& holes);

/// Surfaces between neighbours among `circles` about one axis, ascending by radius: rows and
/// columns between circles whose distance is `row`, unstructured elsewhere.
std::vector<int> add_rings_of_elements(const std::vector<Circle>& circles, double size, double row);

/// Elements of one size everywhere, as `pattern` says.
void set_element_size(double size, Pattern pattern);

void add_physical_group(int dimension, const std::vector<int>& entities, const std::string& name);

}  // namespace chladni::mesh
