#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate::testing {

/// A surface over the unit square, m.
using Surface = std::function<Eigen::Vector3d(double u, double v)>;

/// Division of the unit square into n_u x n_v rectangles, or twice as many triangles.
struct Grid {
  mesh::Shape shape;
  int order;
  int n_u, n_v;
  double distortion = 0.0;  ///< moves inner corners by up to this part of an element, at random,
                            ///< and lays the diagonals of triangles at random
};

/// A shell without supports, and where each node lies in its square.
struct ShellModel {
  mesh::Mesh mesh;
  std::vector<Eigen::Vector2d> uv;  ///< of the surface that came first at this node
  Eigen::SparseMatrix<double> K, M;

  Eigen::Index n_dofs() const { return K.rows(); }
  Eigen::Vector3d position(int node) const { return Eigen::Vector3d(mesh.positions[node].data()); }
};

/// Elements of all surfaces, joined where their nodes meet.
ShellModel shell_model(const std::vector<Surface>& surfaces, const Grid& grid,
                       const Material& material, double thickness);

/// Whether a node belongs to a support or a load, by its place in the square.
using Where = std::function<bool(const Eigen::Vector2d& uv)>;

/// Free DOFs: all but the given components (0..5: u_x .. theta_z) of the nodes of each support.
struct Support {
  Where where;
  std::vector<int> components;
};
std::vector<Eigen::Index> free_dofs(const ShellModel& model, const std::vector<Support>& supports);

/// Nodal forces of a load per area, constant in space, N/m^2.
Eigen::VectorXd area_load(const ShellModel& model, const Eigen::Vector3d& q);

/// Nodal forces of a load per length along the line of nodes `where`, equal in u or in v, that adds
/// up to `force`, N.
Eigen::VectorXd edge_load(const ShellModel& model, const Grid& grid, const Where& where,
                          const Eigen::Vector3d& force);

/// The node nearest to a place in the square.
int node_at(const ShellModel& model, const Eigen::Vector2d& uv);

/// Displacements, zero at the supports.
Eigen::VectorXd solve(const ShellModel& model, const std::vector<Eigen::Index>& free,
                      const Eigen::VectorXd& load);

/// The lowest natural frequencies, Hz, by subspace iteration with K + shift M.
/// @param shift  positive for a body with rigid motions, (rad/s)^2
Eigen::VectorXd frequencies(const ShellModel& model, const std::vector<Eigen::Index>& free,
                            int n_wanted, double shift = 0.0);

/// True along u = value (coordinate 0) or v = value (coordinate 1).
Where on(int coordinate, double value);

/// True on all four sides of the square.
bool on_boundary(const Eigen::Vector2d& uv);

}  // namespace chladni::plate::testing
