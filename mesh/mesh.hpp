#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

enum class Shape { line, triangle, quadrilateral, tetrahedron, hexahedron, wedge };

/// 1 of lines, 2 of surfaces, 3 of solids.
constexpr int dimension(Shape shape)
{
  if (shape == Shape::line) return 1;
  return shape == Shape::triangle || shape == Shape::quadrilateral ? 2 : 3;
}
constexpr bool is_surface(Shape shape)
{
  return dimension(shape) == 2;
}
constexpr bool is_solid(Shape shape)
{
  return dimension(shape) == 3;
}

/// Elements of one shape and order. The nodes of a line or surface element are in lattice order. A
/// quadrilateral of order p has (p+1)^2 nodes, xi fastest; a triangle (p+1)(p+2)/2, r fastest, in
/// rows that get shorter; a line p+1 nodes from end to end. A solid has nodes at its corners and on
/// its edges, in the order of `solid_nodes` (element_types.hpp).
struct ElementBlock {
  Shape shape;
  int order;
  int nodes_per_element;
  std::vector<std::int64_t> numbers;  ///< [n_elements] element numbers of the mesh file
  std::vector<int> nodes;  ///< [n_elements x nodes_per_element] indices into Mesh::positions
  std::vector<int> group;  ///< [n_elements] index into Mesh::groups, -1 = none

  int n_elements() const { return static_cast<int>(numbers.size()); }
  std::span<const int> element_nodes(int e) const
  {
    return std::span(nodes).subspan(std::size_t(e) * nodes_per_element, nodes_per_element);
  }
};

/// A named set of nodes: a physical group or a ring.
struct Group {
  std::string name;
  int dimension;  ///< 0 to 3
  std::vector<int>
      nodes;  ///< indices into Mesh::positions; of a ring ordered by angle, else ascending
};

/// The sectors of a body that is periodic about the z axis. The mesh is the first sector; each
/// other follows from the one before by a turn of 360 degrees / count.
struct Sectors {
  int count = 1;  ///< 1: the mesh is the whole body
  std::vector<std::array<int, 2>>
      pairs;  ///< nodes (low, high) of the cut edges of the mesh: one turn takes low to high
};

/// A node of a ring that no element has. It moves as the face of the solids there does, at a point
/// or in the mean over a patch: u = sum_j w_j u_j, with sum_j w_j = 1 and its position sum_j w_j
/// x_j.
struct FaceNode {
  int node;
  std::vector<int> nodes;  ///< those of the faces
  std::vector<double> weights;
};

/// A linear equation between motions of nodes, sum of its terms = 0.
struct Equation {
  struct Term {
    int node;
    int component;  ///< 0 to 5
    double factor;  ///< of a displacement in m, a rotation in rad
  };
  std::string place;  ///< in the file: "line 7: *EQUATION"
  std::vector<Term> terms;
};

struct NodalMatrices;

/// A mesh of lines, surfaces and solids in space; the same on every rank.
struct Mesh {
  std::vector<std::int64_t> node_numbers;        ///< [n] numbers of the mesh file
  std::vector<std::array<double, 3>> positions;  ///< [n], m
  std::vector<ElementBlock> blocks;              ///< surfaces, solids, and the lines that are beams
  std::vector<Group> groups;
  std::vector<std::string> notes;  ///< for the user: what was changed or left out on reading
  Sectors sectors = {};
  std::vector<FaceNode> face_nodes = {};  ///< of rings on faces
  std::vector<Equation> equations = {};   ///< of a deck
  std::string made_by = {};               ///< path of the library that made it; empty: this program
  /// Matrices of another program for the nodes; its elements are then the geometry alone.
  std::shared_ptr<const NodalMatrices> matrices = {};

  int n_nodes() const { return static_cast<int>(positions.size()); }
};

/// The group of this name.
/// @throws chladni::Error naming the groups that exist.
const Group& find_group(const Mesh& mesh, const std::string& name);

/// Removes the nodes that no element uses, from the groups too. The others keep their order.
/// @param kept  names of groups whose nodes stay in any case; some may not exist
void drop_unused_nodes(Mesh& mesh, std::span<const std::string> kept = {});

/// The FNV-1a hash of coordinates and connectivity, in hexadecimal.
std::string checksum(const Mesh& mesh);

/// A position or a direction in space.
using Vector = std::array<double, 3>;

inline Vector minus(const Vector& a, const Vector& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double norm(const Vector& a)
{
  return std::sqrt(dot(a, a));
}

inline Vector cross(const Vector& a, const Vector& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The direction of `a` with length 1; `a` must not vanish.
inline Vector unit(const Vector& a)
{
  const double length = norm(a);
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// Adds a group for each ring: its nodes at equal angles on a circle about the z axis, the first on
/// the x axis, ordered by angle. Nodes that miss their place by less than a thousandth of the
/// distance between two neighbours are moved there, with a note, unless the mesh has matrices. In a
/// sector the group has the
/// nodes of the sector, including those of both cut edges.
/// A ring on faces gets nodes of its own, each on the free face of the solids there or in the mean
/// over a patch of it, 2 pi r / N long and `width` wide.
/// @throws chladni::Error with the angle when no node of the mesh stands at a place, or when
///         several do, one above the other, and the ring has no z; of a ring on faces where there
///         is no face or where it is not plane, with the heights of those that there are.
void add_rings(Mesh& mesh, std::span<const RingOptions> rings);

}  // namespace chladni::mesh
