#include "mbs_export/orthogonalize.hpp"

#include <algorithm>
#include <cmath>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/decoupled_coordinates.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "linear/dense/orthogonal_factor.hpp"
#include "mbs_export/rigid_body.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace chladni::mbs_export
