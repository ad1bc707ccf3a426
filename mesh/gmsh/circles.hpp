#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// A circle of Gmsh's model about an axis along z, divided into equal arcs. The first arc begins at
/// the angle 0, on the x side of the axis.
struct Circle {
  double radius;            ///< m
  int n_elements;           ///< number of elements of each arc
  std::vector<int> points;  ///< tags in Gmsh
  std::vector<int> arcs;    ///< tags in Gmsh
};

/// Radius, centre and number of arcs of a circle.
struct CirclePlace {
  double radius;                      ///< m
  std::array<double, 3> centre = {};  ///< m
  int n_arcs = 4;
};

/// Adds a circle with elements of about `size` [m], at least 12 of them: a cubic edge of 90 degrees
/// folds its element over.
Circle add_circle(const CirclePlace& place, double size);

/// Adds a circle with as many arcs and elements as `like`.
Circle add_circle(const CirclePlace& place, const Circle& like);

/// Adds rows and columns of elements between two circles with equal arcs; across the rows elements
/// have about `size` [m].
/// @return tags of the surfaces
std::vector<int> add_rows(const Circle& first, const Circle& last, double size);

/// Adds a plane surface between an outer circle and holes in it.
/// @return tag of the surface
int add_plane(const Circle& outer, const std::vector<Circle>& holes);

/// Adds the surfaces between neighbours among `circles`, which have one axis and ascend by radius:
/// rows and columns between circles at the distance `row` [m], unstructured elements elsewhere.
/// @return tags of the surfaces
std::vector<int> add_rings_of_elements(const std::vector<Circle>& circles, double size, double row);

/// Sets one element size [m] everywhere and whether elements are triangles, by `pattern`.
void set_element_size(double size, Pattern pattern);

/// Adds a named physical group of entities of one dimension, given by their tags.
void add_physical_group(int dimension, const std::vector<int>& entities, const std::string& name);

}  // namespace chladni::mesh
