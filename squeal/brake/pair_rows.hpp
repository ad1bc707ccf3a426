#pragma once

#include <Eigen/Core>
#include <array>

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Rows of the motion of a point pair. Two pads on the middle surface of a plate have
/// (w, g_r, g_t) of its point between them; pads on two rings have (w, g_r, g_t, v_r, v_t) of the
/// upper ring, then of the lower one, v its displacements in the plane. (r, t, z) of the upper and
/// of the lower plate follow where pads move.
inline constexpr int middle_rows = 3, face_rows = 5, plate_rows = 6;
inline constexpr int pair_rows_max = 2 * face_rows + plate_rows;

/// Of so many rows, those of the disc.
constexpr int disc_rows(int rows)
{
  return rows < 2 * face_rows ? middle_rows : 2 * face_rows;
}
constexpr bool has_plates(int rows)
{
  return rows > disc_rows(rows);
}

template <class Scalar>
using PairVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, pair_rows_max, 1>;

/// [n x rows]: what each coordinate of disc and pads does at a point pair.
using PairShapes =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, pair_rows_max>;

/// Motion of a point pair and its rates.
struct PointMotion {
  PairVector<double> g, g_dot;
};

/// The two pads of a pair on the undisturbed disc: upper, lower.
using RestStates = std::array<PadState<double>, 2>;

inline RestStates states_at_rest(const PadContact& pad, double speed)
{
  const RingMotion<double> still{};
  return {pad_state(pad, still, speed, 1.0), pad_state(pad, still, speed, -1.0)};
}

/// (w, g_r, g_t) and their rates from the row `first` on.
template <class Scalar>
RingMotion<Scalar> ring_motion(const PairVector<Scalar>& g, const PairVector<Scalar>& g_dot,
                               Eigen::Index first)
{
  return {g[first], g[first + 1], g[first + 2], g_dot[first], g_dot[first + 1], g_dot[first + 2]};
}

/// A ring that moves by v in its plane takes the plate of its pad along backwards: friction knows
/// the relative velocity alone. Under the axis of the pad lies the point that was at -v; a rotation
/// by g that moved it there lowered it by g . v / 2 as well.
template <class Scalar>
void move_in_plane(RingMotion<Scalar>& m, PlateMotion<Scalar>& plate,
                   const Eigen::Vector2<Scalar>& v, const Eigen::Vector2<Scalar>& v_dot)
{
  m.w -= 0.5 * (m.g_r * v[0] + m.g_t * v[1]);
  plate.r_dot -= v_dot[0];
  plate.t_dot -= v_dot[1];
}

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

/// The force of the pad above (sigma = 1) or below its ring, on (w, g_r, g_t, v_r, v_t): of the
/// force (f_r, f_t, -sigma S) on the disc at the contact plane, what is more than at rest. The disc
/// is counted from the sliding equilibrium, deformed by the constant forces of both pads.
template <class Scalar>
Eigen::Matrix<Scalar, face_rows, 1> face_forces(const PadFace& face, const RingMotion<Scalar>& m,
                                                const PadState<Scalar>& state,
                                                const PadState<double>& at_rest, double sigma)
{
  const Scalar lever = lever_arm(face, m);
  return {-sigma * (state.S - at_rest.S), -lever * state.f_r,
          face.distance * at_rest.f_t - lever * state.f_t, state.f_r, state.f_t - at_rest.f_t};
}

/// The force on disc and plates, in the order of the rows, of which a point pair with the friction
/// of an undisturbed disc is free: `at_rest` is counted out of it. On a middle surface the forces
/// at rest of both pads sum to nothing by themselves.
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
