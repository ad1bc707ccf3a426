#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/interpolation.hpp"

namespace chladni::plate {

/// Lattice points of an element with `n` intervals in each direction, in the order of
/// mesh::ElementBlock.
class Lattice {
 public:
  Lattice(mesh::Shape shape, int n) : shape_(shape), n_(n) {}

  mesh::Shape shape() const { return shape_; }
  int n() const { return n_; }
  int size() const;
  int place(int i, int j) const;
  /// Number of points in row j.
  int n_columns(int j) const { return shape_ == mesh::Shape::triangle ? n_ - j + 1 : n_ + 1; }
  int n_rows() const { return shape_ == mesh::Shape::line ? 1 : n_ + 1; }
  /// The places along each edge. Edges and their points are in the order of mesh::edges_of.
  std::vector<std::vector<int>> edges() const;

 private:
  mesh::Shape shape_;
  int n_;
};

/// The places along the edges of an element, 0 to 1, at which it is cut in two, in the order of
/// mesh::edges_of.
using Cuts = std::array<double, 4>;
constexpr Cuts in_the_middle{0.5, 0.5, 0.5, 0.5};

/// The parameters r and s of lattice points, in [0, 1] along the first two edges. Each part between
/// the cuts of opposite edges (of the three edges of a triangle) has equidistant points.
/// @param parts  2, or 1 without cuts
std::vector<std::array<double, 2>> lattice_parameters(const Lattice& lattice, int parts,
                                                      const Cuts& cuts);

/// A part of an element: the lattice place of its first corner, and its direction.
struct Part {
  int i, j, sign;
};

/// All parts of an element that is cut into `parts` in each direction.
std::vector<Part> parts_of(mesh::Shape shape, int parts);

/// The values of the shape functions of an element at some parameters.
/// @return [n_points x nodes_per_element]
Eigen::MatrixXd shapes_at(mesh::Shape shape, int order,
                          const std::vector<std::array<double, 2>>& parameters);

}  // namespace chladni::plate
