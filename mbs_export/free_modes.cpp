#include "mbs_export/free_modes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/attachment_dofs.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// An M_r-orthonormal basis of the rigid-body vectors; their rank is found after scaling to unit
/// length, and centred on the body, so that neither units nor the origin decide.
MatrixXd rigid_basis(const ReducedSystem& reduced)
{
  MatrixXd R = rigid_body_vectors(reduced, centre_of_nodes(reduced));
  // A rotation about the line through all nodes has an arm of round-off only.
  const double arm_round_off = 1e-10 * R.cwiseAbs().maxCoeff();
  for (Index j = 0; j < R.cols(); ++j) {
    const double norm = R.col(j).norm();
    R.col(j) *= norm > arm_round_off ? 1.0 / norm : 0.0;
  }
  Eigen::ColPivHouseholderQR<MatrixXd> qr(R);
  qr.setThreshold(1e-10);
  if (qr.rank() == 0) return MatrixXd(R.rows(), 0);
  const MatrixXd basis = linear::columns_of_Q(qr, qr.rank());
  const Eigen::LLT<MatrixXd> MR(MatrixXd(basis.transpose() * reduced.M * basis));
  if (MR.info() != Eigen::Success) {
    throw Error(
        "orthogonalize: the mass matrix gives a rigid-body motion no mass; has every material "
        "a density, and is M_r symmetric?");
  }
  return MR.matrixL().solve(basis.transpose()).transpose();
}

/// Largest energy that is no support's: round-off in K_r leaves 1e-16 of the largest
/// stiffness-to-mass ratio of the FE model, of which a system with few modes shows nothing. There
/// the least ratio stands for the elastic modes: a mount at 1/1000 of their frequency is still one.
double energy_of_round_off(const ReducedSystem& reduced)
{
  const Eigen::ArrayXd m = reduced.M.diagonal().array(), k = reduced.K.diagonal().array();
  const Eigen::ArrayXd ratio = (m > 0.0).select(k / m, 0.0);
  const double largest = ratio.maxCoeff();
  const double least = (ratio > 1e-10 * largest).select(ratio, largest).minCoeff();
  return std::max(1e-12 * largest, 3e-7 * least);
}

/// The combinations of the rigid-body vectors that K_r does not resist.
RigidModes unresisted(const ReducedSystem& reduced, const MatrixXd& basis)
{
  if (basis.cols() == 0) return {basis, 0.0};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> energies(
      MatrixXd(basis.transpose() * reduced.K * basis));
  const auto free = energies.eigenvalues().array().abs() <= energy_of_round_off(reduced);
  const Index n_rigid = free.count();
  // Ascending: what is free comes first, up to negative round-off.
  const MatrixXd R = basis * energies.eigenvectors().leftCols(n_rigid);
  return {R, n_rigid > 0 ? energies.eigenvalues().head(n_rigid).cwiseAbs().maxCoeff() : 0.0};
}

/// R V, V orthogonal, such that each motion moves coordinates of one set alone, of those that
/// neither K_r nor M_r couples: bending of a flat body, or its motion in the plane. R itself where
/// there is one set.
MatrixXd by_sets(const MatrixXd& R, const ReducedSystem& reduced)
{
  const auto sets = linear::decoupled_coordinates(reduced.K, reduced.M);
  if (R.cols() == 0 || sets.size() == 1) return R;
  // Sum of k R_k^T M_r R_k: of a motion of set k the eigenvalue k.
  MatrixXd numbers = MatrixXd::Zero(R.cols(), R.cols());
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const MatrixXd R_k = R(sets[k], every);
    numbers += double(k) * R_k.transpose() * (reduced.M(sets[k], sets[k]) * R_k);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> motions(numbers);
  MatrixXd some = MatrixXd::Zero(R.rows(), R.cols());
  for (Index j = 0; j < R.cols(); ++j) {
    constexpr double distinct = 1e-6;
    const double k = std::round(motions.eigenvalues()[j]);
    if (std::abs(motions.eigenvalues()[j] - k) > distinct) return R;
    const auto& set = sets[static_cast<std::size_t>(k)];
    some(set, j) = R(set, every) * motions.eigenvectors().col(j);
  }
  return some;
}

}  // namespace

RigidModes rigid_modes(const ReducedSystem& reduced)
{
  RigidModes modes = unresisted(reduced, rigid_basis(reduced));
  modes.R = by_sets(modes.R, reduced);
  return modes;
}

FreeModes orthogonalize(const ReducedSystem& reduced)
{
  const RigidModes rigid = rigid_modes(reduced);
  const linear::Eigenmodes elastic = linear::eigenmodes(reduced.K, reduced.M, rigid.R);
  const Index n_rigid = rigid.R.cols(), n_elastic = elastic.lambda.size();
  FreeModes modes{.omega = VectorXd::Zero(n_rigid + n_elastic),
                  .Q_e = MatrixXd(reduced.K.rows(), n_rigid + n_elastic),
                  .n_rigid = static_cast<int>(n_rigid),
                  .n_massless = elastic.n_massless,
                  .rigid_residual = n_elastic > 0 ? rigid.largest_energy / elastic.lambda[0] : 0.0};
  modes.omega.tail(n_elastic) = elastic.lambda.cwiseSqrt();
  modes.Q_e << rigid.R, elastic.X;
  return modes;
}

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
