#pragma once

#include <cmath>

#include "references/squeal/analytic_body.hpp"

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

}  // namespace chladni::squeal::test
