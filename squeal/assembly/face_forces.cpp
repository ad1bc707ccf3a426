#include "squeal/assembly/face_forces.hpp"

#include <complex>

#include "squeal/brake/friction_range.hpp"
#include "squeal/brake/pair_rows.hpp"
#include "squeal/derivative.hpp"

namespace chladni::squeal {
namespace {

constexpr int pad_rows = 3;  // (r, t, z)

/// What is more than at rest, on the disc and on the pad.
template <class Scalar>
Eigen::VectorX<Scalar> forces_at(const PadContact& pad, double sigma,
                                 const Eigen::VectorX<Scalar>& motion_and_rates, double speed)
{
  const Eigen::Index rows = motion_and_rates.size() / 2, n = rows - pad_rows;
  const PairVector<Scalar> g = motion_and_rates.head(rows), g_dot = motion_and_rates.tail(rows);
  RingMotion<Scalar> m = ring_motion(g, g_dot, 0);
  PlateMotion<Scalar>& plate = sigma > 0.0 ? m.upper : m.lower;
  plate = {g[n + 2], g_dot[n], g_dot[n + 1], g_dot[n + 2]};
  if (n == face_rows) {
    move_in_plane<Scalar>(m, plate, g.template segment<2>(middle_rows),
                          g_dot.template segment<2>(middle_rows));
  }
  const PadState<double> at_rest = pad_state(pad, RingMotion<double>{}, speed, sigma);
  const PadState<Scalar> state = pad_state(pad, m, speed, sigma);
  Eigen::VectorX<Scalar> F(rows);
  F.head(n) = face_forces(face_of(pad, sigma), m, state, at_rest, sigma).head(n);
  F.tail(pad_rows) << -state.f_r, at_rest.f_t - state.f_t, sigma * (state.S - at_rest.S);
  return F;
}

}  // namespace

FaceDerivatives face_derivatives(const PadContact& pad, double sigma, int rows, double speed)
{
  require_in_table(pad, speed);
  const Eigen::MatrixXd D = derivative_at_rest(
      [&](const Eigen::VectorXcd& y) -> Eigen::VectorXcd {
        return forces_at<std::complex<double>>(pad, sigma, y, speed);
      },
      Eigen::Index{2} * rows);
  return {D.leftCols(rows), D.rightCols(rows)};
}

}  // namespace chladni::squeal
