#include "squeal/brake/state_matrix.hpp"

#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed)
{
  const PadSystem pads = pad_system(options, ring_places(disc));
  const InertialDisc brake = with_pads(disc, pads);
  const Eigen::Index n = brake.n_modes();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = brake.C + 2.0 * speed * brake.G;
  for (const PointPair& point : pads.points) {
    const PairShapes S =
        pair_shapes(matrix_of(shapes_at(disc, disc.rings[point.ring], point.angle)), pads, point);
    const PairDerivatives d = pair_derivatives(point.contact, speed, static_cast<int>(S.cols()));
    K -= S * d.D_a * S.transpose();
    C -= S * d.D_p * S.transpose();
  }
  const Eigen::MatrixXd omega = brake.omega.asDiagonal();
  const Eigen::MatrixXd by_omega = brake.omega.cwiseInverse().asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << -speed * brake.D, omega, -omega - K * by_omega, -speed * brake.D - C;
  return A;
}

}  // namespace chladni::squeal
