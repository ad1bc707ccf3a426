#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// What becomes of each element: `parts` times as many along each direction, of another order.
struct Refinement {
  int parts = 1;  ///< 1 or 2
  int order = 1;
  /// [n_nodes] m, with two parts: elements that meet a free edge of a shell at such a node are cut
  /// there, where that is nearer than their middle; empty: all are halved
  std::vector<double> edge_rows = {};
};

/// The elements of a mesh anew, on the same geometry: that of the original's shape functions, and
/// of the circles where the nodes of an edge lie on one.
struct RefinedMesh {
  /// An element of the original.
  struct Place {
    int block, element;
    Eigen::VectorXd shapes;  ///< [nodes_per_element] its shape functions there
  };

  mesh::Mesh mesh;
  std::vector<Place> places;  ///< [n_nodes] one of the elements in which each node lies
};

/// Nodes that both have keep their numbers. Groups of curves gain the nodes of edges of which they
/// have all nodes, groups of surfaces those of such elements too; groups of points and rings gain
/// none, and lose those that the refined elements do not have.
RefinedMesh refined(const mesh::Mesh& mesh, const Refinement& refinement);

/// Whether elements at free edges are much wider than two of these rows.
/// @param rows  [n_nodes] m
bool has_wide_edges(const mesh::Mesh& mesh, const std::vector<double>& rows);

/// Whether groups of points and rings have all their nodes in the refined mesh.
bool keeps_points(const mesh::Mesh& mesh, const mesh::Mesh& refined);

/// Whether all elements exist of the next order, and no group of points and no ring loses nodes
/// there.
bool can_rise(const mesh::Mesh& mesh);

/// Displacements and rotations between the nodes of the original, by its shape functions.
/// @param motions  [6 n x k] of the nodes of the original; row 6 i + c is component c of node i
/// @return [6 n_refined x k]
Eigen::MatrixXd interpolated(const mesh::Mesh& mesh, const RefinedMesh& refined,
                             const Eigen::MatrixXd& motions);

}  // namespace chladni::plate
