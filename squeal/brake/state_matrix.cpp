#include "squeal/brake/state_matrix.hpp"

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/pad_basis.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/point_shapes.hpp"

namespace chladni::squeal {
StackedContact linear_contact(const InertialDisc& disc, const PadSystem& pads, double speed)
{
  StackedContact all = contact_at_rest(pads, disc.n_modes() + pads.n_modes(), speed);
  Eigen::Index at = 0;
  for (const PointPair& point : pads.points) {
    const PairShapes S = pair_shapes(shapes_at(disc, point), pads, point);
    all.S.middleCols(at, S.cols()) = S;
    at += S.cols();
  }
  ContactSeries(disc.compliance, pads, speed).condense(all);
  return all;
}

Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed)
{
  const PadSystem pads = pad_system(options, ring_places(disc));
  const InertialDisc brake = with_pads(disc, pads);
  const Eigen::Index n = brake.n_modes();
  const StackedContact contact = linear_contact(disc, pads, speed);
  const Eigen::MatrixXd K = -contact.S * contact.D_a * contact.S.transpose();
  const Eigen::MatrixXd C =
      brake.C + 2.0 * speed * brake.G - contact.S * contact.D_p * contact.S.transpose();
  const Eigen::MatrixXd omega = brake.omega.asDiagonal();
  const Eigen::MatrixXd by_omega = brake.omega.cwiseInverse().asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << -speed * brake.D, omega, -omega - K * by_omega, -speed * brake.D - C;
  return A;
}

Eigen::MatrixXd smooth_state_matrix(const InertialDisc& disc, const SquealOptions& options,
                                    double speed)
{
  const Eigen::MatrixXd A = state_matrix(disc, options, speed), Psi = pad_basis(options);
  const Eigen::Index n = A.rows() / 2, m = Psi.rows();
  if (m == 0) return A;
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  T.block(n - m, n - m, m, m) = Psi;
  T.bottomRightCorner(m, m) = Psi;
  return T * A * T.transpose();
}

}  // namespace chladni::squeal
