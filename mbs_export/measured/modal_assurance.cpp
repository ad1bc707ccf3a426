#include "mbs_export/measured/modal_assurance.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::Vector3d;

/// All nodes of the body whose displacements it knows: [n x 3] and [3 n x n_modes].
struct KnownNodes {
  MatrixXd positions, motion;
};

KnownNodes known_nodes(const ModalBody& body)
{
  const Index n_drawn = body.picture.positions.rows(),
              n = n_drawn + std::ssize(body.attachment_nodes);
  KnownNodes known{.positions = MatrixXd(n, 3), .motion = MatrixXd(3 * n, body.n_modes())};
  known.positions.topRows(n_drawn) = body.picture.positions;
  if (n_drawn > 0) known.motion.topRows(3 * n_drawn) = body.picture.transformation;
  for (Index i = n_drawn; i < n; ++i) {
    const Index node = i - n_drawn;
    known.positions.row(i) =
        body.attachment_nodes[static_cast<std::size_t>(node)].position.transpose();
    known.motion.middleRows(3 * i, 3) = body.attachment_modes.middleRows(6 * node, 3);
  }
  return known;
}

/// The nearest known node of each measured one.
std::vector<Index> nearest_nodes(const KnownNodes& known, const MeasuredModes& measured)
{
  std::vector<Index> nearest;
  for (const MeasuredNode& node : measured.nodes) {
    Index at = 0;
    (known.positions.rowwise() - node.position.transpose()).rowwise().squaredNorm().minCoeff(&at);
    nearest.push_back(at);
  }
  return nearest;
}

std::vector<MatchedNode> matched_nodes(const KnownNodes& known, const std::vector<Index>& nearest,
                                       const MeasuredModes& measured, double distance)
{
  std::vector<MatchedNode> matched;
  std::map<Index, std::int64_t> taken;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const MeasuredNode& node = measured.nodes[i];
    const Vector3d place = known.positions.row(nearest[i]).transpose();
    const double gap = (place - node.position).norm();
    if (gap > distance) {
      throw Error(fmt::format(
          "measured node {} at ({:.6g}, {:.6g}, {:.6g}) m is {:.3g} m from the nearest node of the "
          "body, and --distance allows {:.3g} m; is its unit of length right, and are the axes "
          "those of the model?",
          node.number, node.position[0], node.position[1], node.position[2], gap, distance));
    }
    const auto [other, is_new] = taken.emplace(nearest[i], node.number);
    if (!is_new) {
      throw Error(
          fmt::format("measured nodes {} and {} are nearest to the same node of the body; "
                      "keep more nodes (reduce.pictures = \"all\")",
                      other->second, node.number));
    }
    matched.push_back({.number = node.number, .position = place, .distance = gap});
  }
  return matched;
}

/// Rows of the measured shapes that are not zero in all of them.
std::vector<Index> measured_rows(const MatrixXcd& shapes)
{
  std::vector<Index> rows;
  for (Index row = 0; row < shapes.rows(); ++row)
    if (shapes.row(row).cwiseAbs().maxCoeff() > 0.0) rows.push_back(row);
  return rows;
}

/// Natural modes among those of the body.
std::vector<Index> natural_modes(const ModalBody& body)
{
  std::vector<Index> modes;
  for (Index i = 0; i < body.n_modes(); ++i)
    if (body.kinds[static_cast<std::size_t>(i)] != ModeKind::interface) modes.push_back(i);
  return modes;
}

MatrixXd assurance(const MatrixXcd& Psi, const MatrixXd& Phi)
{
  const Eigen::VectorXd psi = Psi.colwise().squaredNorm(), phi = Phi.colwise().squaredNorm();
  const MatrixXd products = (Psi.adjoint() * Phi.cast<std::complex<double>>()).cwiseAbs2();
  return psi.cwiseInverse().asDiagonal() * products * phi.cwiseInverse().asDiagonal();
}

void require_motion(const Eigen::VectorXd& squared_norms, const char* what)
{
  for (Index i = 0; i < squared_norms.size(); ++i)
    if (!(squared_norms[i] > 0.0))
      throw Error(fmt::format("{} {} is zero at all measured nodes", what, i + 1));
}

}  // namespace

ModalAssurance modal_assurance(const ModalBody& body, const MeasuredModes& measured,
                               double distance)
{
  const KnownNodes known = known_nodes(body);
  if (known.positions.rows() == 0) throw Error("the body has no nodes to compare shapes at");
  const std::vector<Index> nearest = nearest_nodes(known, measured);
  ModalAssurance found{.nodes = matched_nodes(known, nearest, measured, distance),
                       .n_components = 0,
                       .modes = {},
                       .body_Hz = {},
                       .measured_Hz = measured.f_Hz,
                       .mac = {}};
  const std::vector<Index> rows = measured_rows(measured.shapes), modes = natural_modes(body);
  if (modes.empty()) throw Error("the body has no natural modes to compare with");
  MatrixXd Phi(std::ssize(rows), std::ssize(modes));
  for (Index i = 0; i < Phi.rows(); ++i) {
    const Index row = rows[static_cast<std::size_t>(i)];
    Phi.row(i) = known.motion(3 * nearest[static_cast<std::size_t>(row / 3)] + row % 3, modes);
  }
  const MatrixXcd Psi = measured.shapes(rows, every);
  require_motion(Psi.colwise().squaredNorm().transpose(), "measured shape");
  found.n_components = Phi.rows();
  found.body_Hz = body.omega(modes) / (2.0 * std::numbers::pi);
  for (const Index mode : modes) found.modes.push_back(static_cast<int>(mode) + 1);
  // A mode that does not move there resembles nothing.
  const Eigen::VectorXd at_rest = (Phi.colwise().squaredNorm().array() == 0.0).cast<double>();
  MatrixXd scaled = Phi;
  for (Index j = 0; j < scaled.cols(); ++j)
    if (at_rest[j] > 0.0) scaled.col(j).setOnes();
  found.mac = assurance(Psi, scaled) * (1.0 - at_rest.array()).matrix().asDiagonal();
  return found;
}

}  // namespace chladni::mbs_export
