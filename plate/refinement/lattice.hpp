#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/interpolation.hpp"

namespace chladni::plate {

/// Points of an element, `n` intervals along each direction, in the order of mesh::ElementBlock.
class Lattice {
 public:
  Lattice(mesh::Shape shape, int n) : shape_(shape), n_(n) {}

  mesh::Shape shape() const { return shape_; }
  int n() const { return n_; }
  int size() const;
  int place(int i, int j) const;
  /// The columns of row j.
  int n_columns(int j) const { return shape_ == mesh::Shape::triangle ? n_ - j + 1 : n_ + 1; }
  int n_rows() const { return shape_ == mesh::Shape::line ? 1 : n_ + 1; }
  /// The places along each edge, as mesh::edges_of orders edges and their nodes.
  std::vector<std::vector<int>> edges() const;

 private:
  mesh::Shape shape_;
  int n_;
};

/// The places along the edges of an element, 0 to 1, at which it is cut into halves; as
/// mesh::edges_of orders them.
using Cuts = std::array<double, 4>;
constexpr Cuts in_the_middle{0.5, 0.5, 0.5, 0.5};

/// Where the points of a lattice lie, r and s in [0, 1] along the first two edges: each part
/// between the cuts of opposite edges, or of the three of a triangle, has equidistant ones.
/// @param parts  2, or 1 without cuts
std::vector<std::array<double, 2>> lattice_parameters(const Lattice& lattice, int parts,
                                                      const Cuts& cuts);

/// The lattice of a part of an element: the place of its first corner, and its direction.
struct Part {
  int i, j, sign;
};

/// All parts of an element that is cut into so many along each direction.
std::vector<Part> parts_of(mesh::Shape shape, int parts);

/// Values at these parameters of the shape functions of an element of this order.
/// @return [n_points x nodes_per_element]
Eigen::MatrixXd shapes_at(mesh::Shape shape, int order,
                          const std::vector<std::array<double, 2>>& parameters);

}  // namespace chladni::plate
