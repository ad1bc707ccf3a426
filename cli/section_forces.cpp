#include "cli/section_forces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "plate/beam_element.hpp"
#include "plate/directors.hpp"

namespace chladni::cli {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using mbs_export::ResultantModes;

constexpr Index n_kinds = 6;

/// A line of the mesh and where its points begin.
struct Line {
  const mesh::ElementBlock& block;
  int element;
  Index first_point;
};

std::vector<Line> lines_of(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const auto index = static_cast<int>(&group - mesh.groups.data());
  std::vector<Line> lines;
  Index n_points = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (block.shape != mesh::Shape::line || block.group[e] != index) continue;
      lines.push_back({block, e, n_points});
      n_points += Index{2} * block.order;
    }
  }
  return lines;
}

/// Places, axes and element numbers of the ends of all beams.
void add_points(ResultantModes& forces, const Line& line, const plate::NodeVectors& x,
                const plate::BeamSection& section)
{
  for (Index i = 0; i + 1 < x.rows(); ++i) {
    const Eigen::Matrix3d axes = plate::beam_axes(x.row(i + 1) - x.row(i), section);
    for (Index end = 0; end < 2; ++end) {
      const Index point = line.first_point + 2 * i + end;
      forces.positions.row(point) = x.row(i + end);
      forces.axes.row(point) << axes.row(0), axes.row(1), axes.row(2);
      forces.elements.push_back(line.block.numbers[line.element]);
    }
  }
}

/// Keeps the kinds that some coordinate causes.
void drop_silent_kinds(ResultantModes& forces)
{
  const Index n_points = forces.positions.rows();
  std::vector<Index> kept;
  for (Index kind = 0; kind < n_kinds; ++kind) {
    if (!forces.S(Eigen::seqN(kind, n_points, n_kinds), Eigen::all).isZero(0.0)) {
      kept.push_back(kind);
    }
  }
  std::vector<Index> rows;
  for (Index point = 0; point < n_points; ++point) {
    for (const Index kind : kept) rows.push_back(n_kinds * point + kind);
  }
  ResultantModes all = forces;
  forces.kinds.clear();
  forces.units.clear();
  for (const Index kind : kept) {
    forces.kinds.push_back(all.kinds[static_cast<std::size_t>(kind)]);
    forces.units.push_back(all.units[static_cast<std::size_t>(kind)]);
  }
  forces.S = all.S(rows, Eigen::all);
}

ResultantModes forces_of_group(const mesh::Group& group, const plate::BeamSection& section,
                               const FeModel& fe, const RowsOf& rows_of)
{
  const std::vector<Line> lines = lines_of(fe.mesh, group);
  const MatrixXd u = node_rows(group.nodes, fe.system.dofs, rows_of);
  const Index n_points = lines.back().first_point + Index{2} * lines.back().block.order;
  ResultantModes forces{.name = group.name,
                        .kinds = {"N", "Q_y", "Q_z", "M_x", "M_y", "M_z"},
                        .units = {"N", "N", "N", "N m", "N m", "N m"},
                        .elements = {},
                        .positions = ResultantModes::Rows(n_points, 3),
                        .axes = ResultantModes::Rows(n_points, 9),
                        .S = MatrixXd(n_kinds * n_points, u.cols())};
  for (const Line& line : lines) {
    const plate::NodeVectors x = plate::element_positions(fe.mesh, line.block, line.element);
    add_points(forces, line, x, section);
    MatrixXd u_e(6 * x.rows(), u.cols());
    for (Index i = 0; i < x.rows(); ++i) {
      const int node = line.block.element_nodes(line.element)[static_cast<std::size_t>(i)];
      const auto place = std::ranges::lower_bound(group.nodes, node) - group.nodes.begin();
      u_e.middleRows<6>(6 * i) = u.middleRows<6>(6 * place);
    }
    forces.S.middleRows(n_kinds * line.first_point, 12 * (x.rows() - 1)) =
        plate::beam_section_forces(x, section) * u_e;
  }
  drop_silent_kinds(forces);
  return forces;
}

}  // namespace

std::vector<ResultantModes> section_forces(const std::vector<std::string>& groups,
                                           const std::vector<plate::BeamSection>& beams,
                                           const FeModel& fe, const RowsOf& rows_of)
{
  std::vector<ResultantModes> forces;
  for (const std::string& name : groups) {
    const auto section = std::ranges::find(beams, name, &plate::BeamSection::group);
    if (section == beams.end()) {
      throw Error(
          fmt::format("resultants: the group \"{}\" has no beam section; section forces "
                      "are those of beams",
                      name));
    }
    forces.push_back(forces_of_group(mesh::find_group(fe.mesh, name), *section, fe, rows_of));
  }
  return forces;
}

}  // namespace chladni::cli
