#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Four places in the lattice of an element. A triangle repeats its last place, a line its last
/// place twice.
using LatticeCell = std::array<int, 4>;

/// The cells that an element of the block is drawn by.
/// @param step  width of a cell in lattice intervals: the order of the block gives one cell with
///              the corners of the element, 1 gives all cells of its lattice
std::vector<LatticeCell> lattice_cells(const ElementBlock& block, int step);

/// The nodes of each edge of an element, in order from end to end.
std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element);

/// The places of the nodes of each edge of an element, from end to end.
std::vector<std::vector<int>> places_of_edges(Shape shape, int order);

/// The element edges with all their nodes in the group. An edge between two elements is returned
/// once.
std::vector<std::vector<int>> edges_in(const Mesh& mesh, const Group& group);

/// The lattice places of the nodes in the order of VTK: corners, edges, inner nodes. Up to order 2
/// most other formats have the same order.
/// @param order  1 to 4
std::vector<int> corners_first(Shape shape, int order);

/// The parent coordinates (r, s, t) of the nodes of a solid: corners, then the inner nodes of each
/// edge, from its first corner on; in [-1, 1]^3 of hexahedra, r, s, t >= 0 and r + s + t <= 1 of
/// tetrahedra, a triangle r, s by t in [-1, 1] of wedges. The order is that of VTK up to order 2,
/// and that of Abaqus.
std::vector<std::array<double, 3>> solid_nodes(Shape shape, int order);

/// The faces of a solid as places of its nodes: the corners counter-clockwise seen from outside,
/// then the inner nodes of the edges in the same turn.
std::vector<std::vector<int>> solid_faces(Shape shape, int order);

/// The place that each node of a solid takes when r and s change places, which turns it inside out.
std::vector<int> mirrored_places(Shape shape, int order);

/// The number of corners of an element, which come first in `corners_first` and in a solid.
int n_corners(Shape shape);

/// The number of nodes of an element in an `ElementBlock`.
int n_nodes_of(Shape shape, int order);

/// What is told where tetrahedra and wedges without nodes on their edges got such.
extern const char* const solids_are_raised;

/// The places of the corners of an element, around it if it is a surface.
std::vector<int> corner_places(const ElementBlock& block);

/// A face of a solid that no other solid shares.
struct FreeFace {
  std::size_t block;
  int element;
  std::vector<int> nodes;  ///< as `solid_faces`
};

/// The skin of the solids of a mesh.
std::vector<FreeFace> free_faces(const Mesh& mesh);

/// The shape functions of a face of a solid at a point: quadratic in a triangle; in a quadrilateral
/// (r, s in [-1, 1]) those of the edges, each linear across, less the bilinear ones of the corners.
std::vector<double> face_functions(std::size_t n_nodes, int order, double r, double s);

/// The triangles and quadrilaterals that a face is drawn by, as places in `FreeFace::nodes`.
/// @param with_edge_nodes  not only its corners
std::vector<LatticeCell> face_cells(int n_nodes, int order, bool with_edge_nodes);

/// Derivatives of the shape functions of an element at some points.
struct ShapeDerivatives {
  int n_nodes;
  std::vector<double> first, second;  ///< [n_points x n_nodes], d N_j / d xi or eta at point i

  int n_points() const { return static_cast<int>(first.size()) / n_nodes; }
};

/// The derivatives of the complete Lagrange basis on the equidistant lattice of a triangle or
/// quadrilateral at its own nodes. Parent coordinates are in [0, 1].
ShapeDerivatives node_derivatives(Shape shape, int order);

/// The same at the points of the full integration of the element.
ShapeDerivatives gauss_derivatives(Shape shape, int order);

/// The tangents (a_1, a_2) of an element at one of the points.
std::array<Vector, 2> tangents(const Mesh& mesh, std::span<const int> nodes,
                               const ShapeDerivatives& derivatives, int point);

/// An edge of a surface element at one of its nodes.
struct EdgeAtNode {
  int next, other;  ///< neighbours along the edge, the lower first; at its end -1 for the other
  Vector along, inward;  ///< unit vectors: towards `next`, and square to that into the element
};

/// A surface element at one of its nodes.
struct FaceAtNode {
  Vector normal;                  ///< of length 1
  double angle;                   ///< rad, between its edges; pi at a node inside an edge
  std::vector<EdgeAtNode> edges;  ///< two at a corner, one inside an edge
};

/// An element at one of its nodes.
/// @param place        of the node in the lattice of the element
/// @param derivatives  `node_derivatives` of the block
FaceAtNode face_at_node(const Mesh& mesh, const ElementBlock& block, int element, int place,
                        const ShapeDerivatives& derivatives);

/// The angle between an element and the continuation of its neighbour over their edge, rad: 0 where
/// the surface goes on, pi where one lies on the other.
/// @param a, b  `EdgeAtNode::inward` of both
double fold_angle(const Vector& a, const Vector& b);

}  // namespace chladni::mesh
