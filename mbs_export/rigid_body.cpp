#include "mbs_export/rigid_body.hpp"

#include <Eigen/Geometry>

#include "mbs_export/attachment_motion.hpp"

namespace chladni::mbs_export {
namespace {

using SixVectors = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// int rho (e_i . (e_k x (x - point))) dV = m eps_ikl (c - point)_l, averaged over the translations
/// i that exist.
Eigen::Vector3d centre_from_origin(const Eigen::Matrix<double, 6, 6>& J, double mass)
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int l = 0; l < 3; ++l) {
    const int i = (l + 1) % 3, k = (l + 2) % 3;
    // eps_ikl = 1 and eps_kil = -1
    const bool has_i = J(i, i) > 0.5 * mass, has_k = J(k, k) > 0.5 * mass;
    const double sum = (has_i ? J(i, 3 + k) : 0.0) - (has_k ? J(k, 3 + i) : 0.0);
    if (has_i || has_k) centre[l] = sum / (mass * (int(has_i) + int(has_k)));
  }
  return centre;
}

}  // namespace

SixVectors rigid_body_vectors(const ReducedSystem& reduced, const Eigen::Vector3d& point)
{
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(6 * std::ssize(reduced.attachment_nodes), 6);
  for (Eigen::Index node = 0; node < std::ssize(reduced.attachment_nodes); ++node) {
    motion.middleRows<6>(6 * node).setIdentity();
    const Eigen::Vector3d arm =
        reduced.attachment_nodes[static_cast<std::size_t>(node)].position - point;
    for (int k = 0; k < 3; ++k)
      motion.block<3, 1>(6 * node, 3 + k) = Eigen::Vector3d::Unit(k).cross(arm);
  }
  SixVectors R = SixVectors::Zero(reduced.M.rows(), 6);
  R.topRows(reduced.n_masters()) = masters_of_motion(reduced, motion);
  return R;
}

Eigen::Vector3d centre_of_nodes(const ReducedSystem& reduced)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const AttachmentNode& node : reduced.attachment_nodes) sum += node.position;
  return sum / static_cast<double>(std::max<std::size_t>(1, reduced.attachment_nodes.size()));
}

RigidInertia rigid_inertia(const ReducedSystem& reduced)
{
  const Eigen::Vector3d point = centre_of_nodes(reduced);
  const SixVectors R = rigid_body_vectors(reduced, point);
  const Eigen::Matrix<double, 6, 6> J = R.transpose() * reduced.M * R;
  const double mass = J.diagonal().head<3>().maxCoeff();
  const Eigen::Vector3d centre =
      mass > 0.0 ? Eigen::Vector3d(point + centre_from_origin(J, mass)) : point;
  const SixVectors R_c = rigid_body_vectors(reduced, centre);
  const Eigen::Matrix3d inertia = R_c.rightCols<3>().transpose() * reduced.M * R_c.rightCols<3>();
  return {mass, centre, 0.5 * (inertia + inertia.transpose())};
}

}  // namespace chladni::mbs_export
