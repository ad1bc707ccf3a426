#pragma once

#include <cmath>

#include "tests/references/squeal/analytic_body.hpp"

/// Discs that are not axisymmetric.
namespace chladni::squeal::test {

inline PlatePair turned_by(PlatePair pair, double turn, double split = 0.0)
{
  pair.turn = turn;
  pair.split = split;
  return pair;
}

/// Every function of all rings, f -> change(f).
template <class Change>
Disc with_shapes(Disc disc, const Change& change)
{
  for (DiscRing& ring : disc.rings)
    for (Harmonics* f : {&ring.W, &ring.W_r, &ring.W_t}) change(*f);
  return disc;
}

inline Disc split_disc()
{
  return disc_of({turned_by(kirchhoff_3(), 0.3, 0.01)});
}

/// Twelve vanes: each shape of d diameters has a tenth of 12 - d in it.
inline Disc disc_with_vanes()
{
  const Disc disc = disc_of({turned_by(kirchhoff_2(), 0.2), turned_by(kirchhoff_3(), 0.3)});
  return with_shapes(disc, [](Harmonics& f) {
    for (const int d : {2, 3}) {
      f.cosine.row(12 - d) += 0.1 * f.cosine.row(d);
      f.sine.row(12 - d) -= 0.1 * f.sine.row(d);
    }
  });
}

/// A fifth of two diameters in a mode of three, and the other way round.
inline Disc mistuned_disc()
{
  const Disc disc = disc_of({turned_by(kirchhoff_2(), 0.2), turned_by(kirchhoff_3(), 0.3, 0.003)});
  Eigen::Matrix4d mixed = Eigen::Matrix4d::Identity();
  const double c = std::cos(0.2), s = std::sin(0.2);
  mixed(0, 0) = mixed(3, 3) = c;
  mixed(0, 3) = -s;
  mixed(3, 0) = s;
  return with_shapes(disc, [&](Harmonics& f) {
    f.cosine = f.cosine * mixed;
    f.sine = f.sine * mixed;
  });
}

/// The mass integrals of a body in which S_xy = int rho phi_x phi_y^T dV alone is not zero.
inline mbs_export::MassIntegrals integrals_with(const Eigen::MatrixXd& S_xy)
{
  mbs_export::MassIntegrals integrals{};
  integrals.displacement = Eigen::MatrixXd::Zero(3, S_xy.cols());
  integrals.position_displacement = Eigen::MatrixXd::Zero(9, S_xy.cols());
  integrals.products.fill(Eigen::MatrixXd::Zero(S_xy.rows(), S_xy.cols()));
  integrals.products[3] = S_xy;
  return integrals;
}

/// Two pairs, the second of them split or not, with Coriolis forces: in each pair by the motion of
/// its points in the plane, several times that of a brake disc.
inline Disc disc_with_coriolis(double split)
{
  auto body = analytic_body({turned_by(kirchhoff_2(), 0.2), turned_by(kirchhoff_3(), 0.3, split)});
  Eigen::Matrix4d S_xy = Eigen::Matrix4d::Zero();
  S_xy(0, 1) = 0.1;
  S_xy(2, 3) = 0.2;
  body.mass_integrals = integrals_with(S_xy);
  return disc_on_ring(body, "track", {});
}

}  // namespace chladni::squeal::test
