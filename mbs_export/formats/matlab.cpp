#include "mbs_export/formats/matlab.hpp"

#include <fmt/format.h>

#include <vector>

#include "mbs_export/formats/mat_file.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::MatrixXd;

/// Indices from 1, as MATLAB counts.
MatArray numbers(const std::vector<int>& indices)
{
  MatrixXd column(std::ssize(indices), 1);
  for (Eigen::Index i = 0; i < column.size(); ++i) column(i) = indices[std::size_t(i)] + 1;
  return mat_array(column);
}

MatArray scalar(double x)
{
  return mat_array(MatrixXd::Constant(1, 1, x));
}

std::vector<std::string> kinds_of(const ModalBody& body)
{
  std::vector<std::string> kinds;
  for (const ModeKind kind : body.kinds) {
    kinds.emplace_back(kind == ModeKind::rigid         ? "rigid"
                       : kind == ModeKind::constrained ? "constrained"
                                                       : "interface");
  }
  return kinds;
}

/// Node and component of each row of the modes at the attachment nodes.
MatrixXd rows_of(const ModalBody& body)
{
  MatrixXd rows(body.attachment_modes.rows(), 2);
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const Eigen::Index node = row / 6 + 1, component = row % 6 + 1;
    rows(row, 0) = double(node);
    rows(row, 1) = double(component);
  }
  return rows;
}

MatFields nodes_of(const ModalBody& body)
{
  const Eigen::Index n = std::ssize(body.attachment_nodes);
  MatrixXd positions(n, 3), node_numbers(n, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AttachmentNode& node = body.attachment_nodes[std::size_t(i)];
    node_numbers(i) = double(node.number);
    positions.row(i) = Eigen::Map<const Eigen::RowVector3d>(node.position.data());
  }
  return {{"node_numbers", mat_array(node_numbers)}, {"node_positions", mat_array(positions)}};
}

std::vector<MatFields> sets_of(const ModalBody& body)
{
  std::vector<MatFields> sets;
  for (const AttachmentSet& set : body.sets)
    sets.push_back({{"name", mat_array(set.name)}, {"nodes", numbers(set.nodes)}});
  return sets;
}

std::vector<MatFields> rings_of(const ModalBody& body)
{
  std::vector<MatFields> rings;
  for (const ContactRing& ring : body.rings) {
    rings.push_back({{"name", mat_array(ring.name)},
                     {"radius", scalar(ring.radius)},
                     {"height", scalar(ring.height)},
                     {"nodes", numbers(ring.nodes)},
                     {"angles", mat_array(MatrixXd(ring.angles))},
                     {"displacement", mat_array(ring.W)},
                     {"radial_slope", mat_array(ring.W_r)},
                     {"circumferential_slope", mat_array(ring.W_t)}});
  }
  return rings;
}

/// The matrix of each load.
std::vector<MatFields> stiffening_of(const Stiffening& stiffening)
{
  std::vector<MatFields> loads;
  for (std::size_t i = 0; i < stiffening.loads.size(); ++i) {
    loads.push_back(
        {{"load", mat_array(stiffening.loads[i])}, {"matrix", mat_array(stiffening.K[i])}});
  }
  return loads;
}

}  // namespace

std::string matlab_body(const ModalBody& body)
{
  MatFields fields{{"title", mat_array(body.title)},
                   {"frequencies", mat_array(MatrixXd(body.omega))},
                   {"kinds", mat_array(kinds_of(body))},
                   {"damping", mat_array(body.C)},
                   {"structural_damping", mat_array(body.H)},
                   {"attachment_displacements", mat_array(body.attachment_modes)},
                   {"row_nodes", mat_array(MatrixXd(rows_of(body).col(0)))},
                   {"row_components", mat_array(MatrixXd(rows_of(body).col(1)))},
                   {"sets", mat_array(sets_of(body))},
                   {"rings", mat_array(rings_of(body))},
                   {"fixed", mat_array(body.fixed)},
                   {"mass", scalar(body.mass)},
                   {"centre_of_mass", mat_array(MatrixXd(body.centre_of_mass))},
                   {"inertia", mat_array(MatrixXd(body.inertia))},
                   {"free_frequencies", mat_array(MatrixXd(body.free_frequencies))},
                   {"free_rigid_modes", scalar(body.n_rigid)}};
  for (auto& field : nodes_of(body)) fields.push_back(std::move(field));
  if (body.stiffening)
    fields.emplace_back("stiffening", mat_array(stiffening_of(*body.stiffening)));
  return mat_file("MATLAB 5.0 MAT-file, a modal body of Chladni in SI units", "body",
                  mat_array(std::vector<MatFields>{std::move(fields)}));
}

}  // namespace chladni::mbs_export::formats
