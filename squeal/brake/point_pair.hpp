#pragma once

#include <Eigen/Core>

#include <array>

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Rows of a point pair's motion. Two pads on the middle surface of a plate have (w, g_r, g_t) of
/// the point between them. Pads on two rings have (w, g_r, g_t, v_r, v_t) of the upper ring, then
/// of the lower ring, where v is the in-plane displacement. If pads have a mass, (r, t, z) of the
/// upper and of the lower plate follow.
inline constexpr int middle_rows = 3, face_rows = 5, plate_rows = 6;
inline constexpr int pair_rows_max = 2 * face_rows + plate_rows;

/// Number of rows of the disc among all rows of a point pair.
constexpr int disc_rows(int rows)
{
  return rows < 2 * face_rows ? middle_rows : 2 * face_rows;
}
constexpr bool has_plates(int rows)  ///< whether rows of plates follow those of the disc
{
  return rows > disc_rows(rows);
}

template <class Scalar>
using PairVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, pair_rows_max, 1>;

/// [n x rows] motion of a point pair by each coordinate of disc and pads.
using PairShapes =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, pair_rows_max>;

/// Motion g of a point pair and its rates.
struct PointMotion {
  PairVector<double> g, g_dot;
};

/// States of the upper and the lower pad on the undeformed disc.
using RestStates = std::array<PadState<double>, 2>;

/// The states at a rotation speed (rad/s).
inline RestStates states_at_rest(const PadContact& pad, double speed)
{
  const RingMotion<double> still{};
  return {pad_state(pad, still, speed, 1.0), pad_state(pad, still, speed, -1.0)};
}

/// Reads (w, g_r, g_t) and their rates from the row `first` on.
template <class Scalar>
RingMotion<Scalar> ring_motion(const PairVector<Scalar>& g, const PairVector<Scalar>& g_dot,
                               Eigen::Index first)
{
  return {g[first], g[first + 1], g[first + 2], g_dot[first], g_dot[first + 1], g_dot[first + 2]};
}

/// Includes the in-plane displacement v of a ring. It acts as the opposite velocity of the pad's
/// plate, because friction depends on the relative velocity only. The point under the pad axis is
/// then the one that was at -v; the slopes g change its height by -g . v / 2.
template <class Scalar>
void move_in_plane(RingMotion<Scalar>& m, PlateMotion<Scalar>& plate,
                   const Eigen::Vector2<Scalar>& v, const Eigen::Vector2<Scalar>& v_dot)
{
  m.w -= 0.5 * (m.g_r * v[0] + m.g_t * v[1]);
  plate.r_dot -= v_dot[0];
  plate.t_dot -= v_dot[1];
}

/// Converts the rows of a point pair to the motion under both pads.
template <class Scalar>
PairMotion<Scalar> pair_motion(const PairVector<Scalar>& g, const PairVector<Scalar>& g_dot)
{
  const auto rows = static_cast<int>(g.size());
  const Eigen::Index n = disc_rows(rows);
  const bool two_rings = n > middle_rows;
  PairMotion<Scalar> m{ring_motion(g, g_dot, 0), ring_motion(g, g_dot, two_rings ? face_rows : 0)};
  if (has_plates(rows)) {
    m.upper.upper = {g[n + 2], g_dot[n], g_dot[n + 1], g_dot[n + 2]};
    m.lower.lower = {g[n + 5], g_dot[n + 3], g_dot[n + 4], g_dot[n + 5]};
  }
  if (two_rings) {
    move_in_plane<Scalar>(m.upper, m.upper.upper, g.template segment<2>(3),
                          g_dot.template segment<2>(3));
    move_in_plane<Scalar>(m.lower, m.lower.lower, g.template segment<2>(8),
                          g_dot.template segment<2>(8));
  }
  return m;
}

/// Force of the pad above (sigma = 1) or below its ring on (w, g_r, g_t, v_r, v_t), from the force
/// (f_r, f_t, -sigma S) at the contact plane minus that at rest. The disc's motion is measured from
/// the sliding equilibrium, in which the constant forces of both pads already deform it.
template <class Scalar>
Eigen::Matrix<Scalar, face_rows, 1> face_forces(const PadFace& face, const RingMotion<Scalar>& m,
                                                const PadState<Scalar>& state,
                                                const PadState<double>& at_rest, double sigma)
{
  const Scalar lever = lever_arm(face, m);
  return {-sigma * (state.S - at_rest.S), -lever * state.f_r,
          face.distance * at_rest.f_t - lever * state.f_t, state.f_r, state.f_t - at_rest.f_t};
}

/// Force on disc and plates in the order of the rows. The forces `at_rest`, which the friction on
/// the undeformed disc causes, are subtracted; on a middle surface those of both pads cancel by
/// themselves.
template <class Scalar>
PairVector<Scalar> pair_forces(const PadContact& pad, const PairMotion<Scalar>& m,
                               const ContactResult<Scalar>& at, const RestStates& at_rest, int rows)
{
  PairVector<Scalar> F(rows);
  const PadState<Scalar>&up = at.upper, &lo = at.lower;
  if (disc_rows(rows) == middle_rows) {
    const RingForce<Scalar> on_disc = pair_force(pad, m.upper, up, lo);
    F.template head<middle_rows>() << on_disc.F_w, on_disc.F_r, on_disc.F_t;
  } else {
    F.template head<face_rows>() = face_forces(pad.faces[0], m.upper, up, at_rest[0], 1.0);
    F.template segment<face_rows>(face_rows) =
        face_forces(pad.faces[1], m.lower, lo, at_rest[1], -1.0);
  }
  if (has_plates(rows)) {
    F.template tail<plate_rows>() << -up.f_r, at_rest[0].f_t - up.f_t, up.S - at_rest[0].S, -lo.f_r,
        at_rest[1].f_t - lo.f_t, at_rest[1].S - lo.S;
  }
  return F;
}

}  // namespace chladni::squeal
