#include "cases/section_forces.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "cases/fe_model.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_resultants.hpp"
#include "plate/elements/solid_element.hpp"
#include "plate/sections/sections.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using mbs_export::ResultantModes;

namespace {

/// An element and the index of the first of its points.
struct ChosenElement {
  const mesh::ElementBlock& block;
  int element;
  Eigen::Index first_point;
};

/// The chosen elements of one group of the mesh.
struct Chosen {
  std::string group;
  std::vector<ChosenElement> elements;
  std::vector<int> nodes;  ///< ascending
  Eigen::Index n_points = 0;
};

/// The elements of the group that the choice names, or all of them.
/// @param points_of  number of points of an element of the block; elements with none are left out
/// @throws chladni::Error when no element is left.
Chosen choose_elements(const mesh::Mesh& mesh, const std::string& group,
                       const scene::ResultantChoice& choice,
                       const std::function<Index(const mesh::ElementBlock&)>& points_of)
{
  const auto index = static_cast<int>(&mesh::find_group(mesh, group) - mesh.groups.data());
  Chosen chosen{.group = group, .elements = {}, .nodes = {}};
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const Index n_points = points_of(block);
    for (int e = 0; n_points > 0 && e < block.n_elements(); ++e) {
      const bool wanted =
          choice.elements.empty() ||
          std::ranges::find(choice.elements, block.numbers[e]) != choice.elements.end();
      if (block.group[e] != index || !wanted) continue;
      chosen.elements.push_back({block, e, chosen.n_points});
      chosen.n_points += n_points;
      const auto nodes = block.element_nodes(e);
      chosen.nodes.insert(chosen.nodes.end(), nodes.begin(), nodes.end());
    }
  }
  std::ranges::sort(chosen.nodes);
  chosen.nodes.erase(std::unique(chosen.nodes.begin(), chosen.nodes.end()), chosen.nodes.end());
  if (!chosen.elements.empty()) return chosen;
  throw Error(fmt::format("resultants: the group \"{}\" has {}", group,
                          choice.elements.empty() ? "no elements with section forces"
                                                  : "none of reduce.resultant_elements"));
}

/// The rows of the nodes of an element.
/// @param rows  [6 n_nodes x n] for Chosen::nodes
/// @return [6 n_e x n]
MatrixXd rows_of_element(const Chosen& chosen, const ChosenElement& element, const MatrixXd& rows)
{
  const std::span<const int> nodes = element.block.element_nodes(element.element);
  MatrixXd of_element(6 * std::ssize(nodes), rows.cols());
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    const auto place = std::ranges::lower_bound(chosen.nodes, nodes[static_cast<std::size_t>(i)]) -
                       chosen.nodes.begin();
    of_element.middleRows<6>(6 * i) = rows.middleRows<6>(6 * place);
  }
  return of_element;
}

/// Removes the kinds that are zero for all coordinates.
void drop_silent_kinds(mbs_export::ResultantModes& forces);

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

/// The number of these points in a shell element; 0 for a line.
Index points_of_shell(const mesh::ElementBlock& block)
{
  return block.shape == mesh::Shape::line
             ? 0
             : plate::resultant_points(block.shape, block.order).size();
}

/// Membrane forces N_x, N_y, N_xy, moments M_x, M_y, M_xy and shear forces Q_x, Q_y per length, at
/// the Gauss points where they are most accurate (p x p for order p). Axes: e_z is the director,
/// e_x the global x axis in the tangent plane (y where the shell faces x). Kinds that no component
/// of the model can cause are left out.
/// @note   Collective, as `rows_of`.
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

void drop_silent_kinds(mbs_export::ResultantModes& forces)
{
  const Index n = std::ssize(forces.kinds);
  const Index n_points = forces.positions.rows();
  std::vector<Index> kept;
  for (Index kind = 0; kind < n; ++kind)
    if (!forces.S(Eigen::seqN(kind, n_points, n), every).isZero(0.0)) kept.push_back(kind);
  std::vector<Index> rows;
  for (Index point = 0; point < n_points; ++point)
    for (const Index kind : kept) rows.push_back(n * point + kind);
  mbs_export::ResultantModes all = forces;
  forces.kinds.clear();
  forces.units.clear();
  for (const Index kind : kept) {
    forces.kinds.push_back(all.kinds[static_cast<std::size_t>(kind)]);
    forces.units.push_back(all.units[static_cast<std::size_t>(kind)]);
  }
  forces.S = all.S(rows, every);
}

constexpr Index n_line_kinds = 6;

Index points_of_line(const mesh::ElementBlock& block)
{
  return block.shape == mesh::Shape::line ? Index{block.nodes_per_element} : 0;
}

/// Places, axes and element numbers of the nodes of all lines.
void add_points(ResultantModes& forces, const ChosenElement& line, const plate::NodeVectors& x,
                const plate::BeamSection& section)
{
  const std::vector<Eigen::Matrix3d> axes = plate::node_axes(x, section);
  for (Index i = 0; i < x.rows(); ++i) {
    const Eigen::Matrix3d& here = axes[static_cast<std::size_t>(i)];
    forces.positions.row(line.first_point + i) = x.row(i);
    forces.axes.row(line.first_point + i) << here.row(0), here.row(1), here.row(2);
    forces.elements.push_back(line.block.numbers[line.element]);
  }
}

ResultantModes beam_section_forces(const Chosen& chosen, const plate::BeamSection& section,
                                   const MeshedDofs& fe, const RowsOf& rows_of)
{
  const MatrixXd u = node_rows(chosen.nodes, fe.dofs, rows_of);
  const Index n_points = chosen.n_points;
  ResultantModes forces{.name = chosen.group,
                        .kinds = {"N", "Q_y", "Q_z", "M_x", "M_y", "M_z"},
                        .units = {"N", "N", "N", "N m", "N m", "N m"},
                        .elements = {},
                        .positions = ResultantModes::Rows(n_points, 3),
                        .axes = ResultantModes::Rows(n_points, 9),
                        .S = MatrixXd(n_line_kinds * n_points, u.cols())};
  const std::vector<char> on_surface = plate::nodes_on_surfaces(fe.mesh);
  for (const ChosenElement& line : chosen.elements) {
    const plate::LineFields fields =
        plate::line_fields(on_surface, line.block.element_nodes(line.element));
    const plate::NodeVectors x = plate::element_positions(fe.mesh, line.block, line.element);
    add_points(forces, line, x, section);
    const MatrixXd u_e = rows_of_element(chosen, line, u);
    forces.S.middleRows(n_line_kinds * line.first_point, n_line_kinds * x.rows()) =
        plate::beam_section_forces(x, section, fields) * u_e;
  }
  drop_silent_kinds(forces);
  return forces;
}

Index points_of_solid(const mesh::ElementBlock& block)
{
  return mesh::is_solid(block.shape) ? plate::stress_points_of(block.shape, block.order) : 0;
}

/// The six stresses in the axes of the model where they are most accurate
/// (plate::solid_stresses).
/// @note   Collective, as `rows_of`.
ResultantModes solid_stresses(const Chosen& chosen, const plate::SolidSection& section,
                              const MeshedDofs& fe, const RowsOf& rows_of)
{
  const MatrixXd u = node_rows(chosen.nodes, fe.dofs, rows_of);
  ResultantModes forces{
      .name = chosen.group,
      .kinds = {"sigma_x", "sigma_y", "sigma_z", "sigma_xy", "sigma_yz", "sigma_xz"},
      .units = {"Pa", "Pa", "Pa", "Pa", "Pa", "Pa"},
      .elements = {},
      .positions = ResultantModes::Rows(chosen.n_points, 3),
      .axes = Matrix3d::Identity().reshaped().transpose().replicate(chosen.n_points, 1),
      .S = MatrixXd(n_line_kinds * chosen.n_points, u.cols())};
  for (const ChosenElement& solid : chosen.elements) {
    const auto& [block, element, first] = solid;
    const auto [x, S_e] =
        plate::solid_stresses(block.shape, block.order,
                              plate::element_positions(fe.mesh, block, element), section.material);
    forces.positions.middleRows(first, x.rows()) = x;
    forces.elements.insert(forces.elements.end(), std::size_t(x.rows()), block.numbers[element]);
    forces.S.middleRows(6 * first, S_e.rows()) = S_e * rows_of_element(chosen, solid, u);
  }
  drop_silent_kinds(forces);
  return forces;
}

}  // namespace

std::vector<ResultantModes> section_forces(const scene::ResultantChoice& choice,
                                           const plate::Structure& structure, const MeshedDofs& fe,
                                           const RowsOf& rows_of)
{
  std::vector<ResultantModes> forces;
  for (const std::string& name : choice.groups) {
    const auto shell = std::ranges::find(structure.shells, name, &plate::ShellSection::group);
    if (shell != structure.shells.end()) {
      forces.push_back(shell_section_forces(choose_elements(fe.mesh, name, choice, points_of_shell),
                                            *shell, fe, rows_of));
      continue;
    }
    const auto solid = std::ranges::find(structure.solids, name, &plate::SolidSection::group);
    if (solid != structure.solids.end()) {
      forces.push_back(solid_stresses(choose_elements(fe.mesh, name, choice, points_of_solid),
                                      *solid, fe, rows_of));
      continue;
    }
    const auto section = std::ranges::find(structure.beams, name, &plate::BeamSection::group);
    if (section == structure.beams.end()) {
      throw Error(fmt::format(
          "resultants: the group \"{}\" has no section; section forces are those of beams and "
          "shells, and stresses those of solids",
          name));
    }
    forces.push_back(beam_section_forces(choose_elements(fe.mesh, name, choice, points_of_line),
                                         *section, fe, rows_of));
  }
  return forces;
}

}  // namespace chladni::cases
