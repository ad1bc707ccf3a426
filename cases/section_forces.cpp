#include "cases/section_forces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cases/shell_section_forces.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "plate/elements/beam_axes.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/sections/directors.hpp"
#include "plate/sections/section_map.hpp"

namespace chladni::cases {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using mbs_export::ResultantModes;

constexpr Index n_kinds = 6;

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
                        .S = MatrixXd(n_kinds * n_points, u.cols())};
  const std::vector<char> on_surface = plate::nodes_on_surfaces(fe.mesh);
  for (const ChosenElement& line : chosen.elements) {
    const plate::LineFields fields =
        plate::line_fields(on_surface, line.block.element_nodes(line.element));
    const plate::NodeVectors x = plate::element_positions(fe.mesh, line.block, line.element);
    add_points(forces, line, x, section);
    const MatrixXd u_e = rows_of_element(chosen, line, u);
    forces.S.middleRows(n_kinds * line.first_point, n_kinds * x.rows()) =
        plate::beam_section_forces(x, section, fields) * u_e;
  }
  drop_silent_kinds(forces);
  return forces;
}

}  // namespace

void drop_silent_kinds(ResultantModes& forces)
{
  const Index n = std::ssize(forces.kinds);
  const Index n_points = forces.positions.rows();
  std::vector<Index> kept;
  for (Index kind = 0; kind < n; ++kind)
    if (!forces.S(Eigen::seqN(kind, n_points, n), every).isZero(0.0)) kept.push_back(kind);
  std::vector<Index> rows;
  for (Index point = 0; point < n_points; ++point)
    for (const Index kind : kept) rows.push_back(n * point + kind);
  ResultantModes all = forces;
  forces.kinds.clear();
  forces.units.clear();
  for (const Index kind : kept) {
    forces.kinds.push_back(all.kinds[static_cast<std::size_t>(kind)]);
    forces.units.push_back(all.units[static_cast<std::size_t>(kind)]);
  }
  forces.S = all.S(rows, every);
}

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
    const auto section = std::ranges::find(structure.beams, name, &plate::BeamSection::group);
    if (section == structure.beams.end()) {
      throw Error(fmt::format(
          "resultants: the group \"{}\" has no section; section forces are those of beams and "
          "shells",
          name));
    }
    forces.push_back(beam_section_forces(choose_elements(fe.mesh, name, choice, points_of_line),
                                         *section, fe, rows_of));
  }
  return forces;
}

}  // namespace chladni::cases
