#include "cases/shell_section_forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "plate/elements/shell_resultants.hpp"
#include "plate/sections/directors.hpp"

namespace chladni::cases {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using mbs_export::ResultantModes;

constexpr Index n_kinds = 8;

/// Columns e_x, e_y, e_z for a director.
Matrix3d shell_axes(const Vector3d& director)
{
  const Vector3d e_z = director.normalized();
  const Vector3d along = std::abs(e_z.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d e_x = (along - along.dot(e_z) * e_z).normalized();
  Matrix3d axes;
  axes << e_x, e_z.cross(e_x), e_z;
  return axes;
}

/// From the components xx, yy, zz, xy, yz, xz.
Matrix3d tensor(const Eigen::RowVector<double, 6>& a)
{
  Matrix3d A;
  A << a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2];
  return A;
}

/// N_x, N_y, N_xy, M_x, M_y, M_xy, Q_x, Q_y at one point.
Eigen::Vector<double, n_kinds> in_axes(const plate::ShellResultants& forces, Index point,
                                       const Matrix3d& axes)
{
  const Matrix3d N = axes.transpose() * tensor(forces.N.row(point)) * axes;
  const Matrix3d M = axes.transpose() * tensor(forces.M.row(point)) * axes;
  const Vector3d Q = axes.transpose() * forces.Q.row(point).transpose();
  return {N(0, 0), N(1, 1), N(0, 1), M(0, 0), M(1, 1), M(0, 1), Q[0], Q[1]};
}

/// Fills places, axes and element numbers of its points.
/// @return [8 n_points x 6 n] the forces as linear forms in the motion of its mid-surface nodes
MatrixXd add_points(ResultantModes& forces, const ChosenElement& shell,
                    const plate::ShellNodes& nodes, const plate::Material& material)
{
  const auto& [block, element, first] = shell;
  const plate::Points points = plate::resultant_points(block.shape, block.order);
  const MatrixXd N = plate::lagrange_basis(block.shape, block.order, points).N;
  const MatrixXd x = N * nodes.x, D = N * nodes.D;
  const Index n_dofs = 6 * nodes.x.rows();
  const auto of_each = plate::shell_resultants_of(block.shape, block.order, nodes, material,
                                                  MatrixXd::Identity(n_dofs, n_dofs));
  MatrixXd S_e(n_kinds * points.size(), n_dofs);
  for (Index q = 0; q < points.size(); ++q) {
    const Matrix3d axes = shell_axes(D.row(q).transpose());
    forces.positions.row(first + q) = x.row(q);
    forces.axes.row(first + q) = axes.reshaped().transpose();
    forces.elements.push_back(block.numbers[element]);
    for (Index dof = 0; dof < n_dofs; ++dof) {
      S_e.block<n_kinds, 1>(n_kinds * q, dof) =
          in_axes(of_each[static_cast<std::size_t>(dof)], q, axes);
    }
  }
  return S_e;
}

/// Motion of the mid-surface nodes from that of the nodes of the mesh.
MatrixXd along_arms(MatrixXd u_e, const plate::NodeVectors& arms)
{
  for (Index i = 0; i < arms.rows(); ++i) {
    u_e.middleRows<6>(6 * i) =
        (plate::rigid_arm(arms.row(i).transpose()) * u_e.middleRows<6>(6 * i)).eval();
  }
  return u_e;
}

}  // namespace

Index points_of_shell(const mesh::ElementBlock& block)
{
  return block.shape == mesh::Shape::line
             ? 0
             : plate::resultant_points(block.shape, block.order).size();
}

ResultantModes shell_section_forces(const Chosen& chosen, const plate::ShellSection& section,
                                    const MeshedDofs& fe, const RowsOf& rows_of)
{
  const plate::Directors directors = plate::shell_directors(fe.mesh);
  const MatrixXd rows = node_rows(chosen.nodes, fe.dofs, rows_of);
  ResultantModes forces{.name = chosen.group,
                        .kinds = {"N_x", "N_y", "N_xy", "M_x", "M_y", "M_xy", "Q_x", "Q_y"},
                        .units = {"N/m", "N/m", "N/m", "N", "N", "N", "N/m", "N/m"},
                        .elements = {},
                        .positions = ResultantModes::Rows(chosen.n_points, 3),
                        .axes = ResultantModes::Rows(chosen.n_points, 9),
                        .S = MatrixXd(n_kinds * chosen.n_points, rows.cols())};
  for (const ChosenElement& shell : chosen.elements) {
    const plate::ShellNodes nodes =
        plate::shell_nodes(fe.mesh, shell.block, shell.element, directors, section);
    const plate::NodeVectors arms =
        nodes.x - plate::element_positions(fe.mesh, shell.block, shell.element);
    const MatrixXd S_e = add_points(forces, shell, nodes, section.material);
    forces.S.middleRows(n_kinds * shell.first_point, S_e.rows()) =
        S_e * along_arms(rows_of_element(chosen, shell, rows), arms);
  }
  drop_silent_kinds(forces);
  return forces;
}

}  // namespace chladni::cases
