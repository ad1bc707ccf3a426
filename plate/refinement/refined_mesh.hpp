#pragma once

#include <Eigen/Core>

#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// The refinement of each element: the number of parts in each direction, and their order.
struct Refinement {
  int parts = 1;  ///< 1 or 2
  int order = 1;
  /// [n_nodes] m. With two parts, elements at a free edge of a shell are cut at this distance from
  /// it if that is nearer than their middle. Empty: all are halved.
  std::vector<double> edge_rows = {};
};

/// A mesh with other elements on the same geometry, which is that of the original's shape
/// functions, and in shells of circles where the nodes of an edge lie on one.
struct RefinedMesh {
  /// A point in an element of the original.
  struct Place {
    int block, element;
    /// [nodes_per_element] values of its shape functions at the point
    Eigen::VectorXd shapes;
  };

  mesh::Mesh mesh;
  /// [n_nodes] Each node in one of the elements of the original that contain it. Nodes of no
  /// element have shapes of zero.
  std::vector<Place> places;
};

/// Refines a mesh. Two parts in each direction are eight of a solid. Nodes of the original that
/// remain keep their numbers. A group of curves gains the nodes of edges that it contains, a group
/// of surfaces also those of such elements, and any group but one of curves those of the free faces
/// of solids that it contains. Groups of points and rings gain no nodes, and lose those that the
/// refined elements do not have. Nodes on faces follow the nodes that they followed.
RefinedMesh refined(const mesh::Mesh& mesh, const Refinement& refinement);

/// True if an element at a free edge is much wider than two rows, so that it would not be halved in
/// the middle.
/// @param rows  [n_nodes] m
bool has_wide_edges(const mesh::Mesh& mesh, const std::vector<double>& rows);

/// True if groups of points and rings have all their nodes in the refined mesh.
bool keeps_points(const mesh::Mesh& mesh, const mesh::Mesh& refined);

/// True if all elements are of one order, the next order exists for all, and no group of points and
/// no ring loses nodes in it, nor a face those that nodes on it follow.
bool can_rise(const mesh::Mesh& mesh);

/// Displacements and rotations of the refined nodes, interpolated by the original's shape
/// functions.
/// @param motions  [6 n x k] of the nodes of the original; row 6 i + c is component c of node i
/// @return [6 n_refined x k]
Eigen::MatrixXd interpolated(const mesh::Mesh& mesh, const RefinedMesh& refined,
                             const Eigen::MatrixXd& motions);

}  // namespace chladni::plate
