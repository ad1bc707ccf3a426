#include "squeal/transient/sticking.hpp"

#include <cmath>

namespace chladni::squeal {
namespace {

/// eps over the speed of sliding. The creep of a pad that sticks is an error of first order in it.
constexpr double creep = 1e-3;

/// sum over the harmonics of the amplitude of each mode, a bound of its largest value.
Eigen::ArrayXd amplitudes(const Harmonics& f)
{
  return (f.cosine.cwiseAbs2() + f.sine.cwiseAbs2()).cwiseSqrt().colwise().sum().transpose();
}

}  // namespace

SquealOptions with_friction_at_rest(SquealOptions options, const Disc& disc, double speed)
{
  const auto regularise = [&](FrictionLaw& law) {
    if (law.regularisation == 0.0)
      law.regularisation = creep * std::abs(speed) * disc.rings.front().radius;
  };
  regularise(options.friction);
  for (PadPair& pad : options.pads)
    if (pad.friction) regularise(*pad.friction);
  return options;
}

double surface_speed(const Disc& disc, double thickness, const ModalState& start)
{
  const DiscRing& ring = disc.rings.front();
  const Eigen::ArrayXd slopes =
      (amplitudes(ring.W_r).square() + amplitudes(ring.W_t).square()).sqrt();
  const Eigen::ArrayXd rates =
      (disc.omega.cwiseProduct(start.q).cwiseAbs2() + start.v.cwiseAbs2()).cwiseSqrt().array();
  const double bending = 0.5 * thickness * (slopes * rates).sum();
  if (ring.V_r.cosine.size() == 0) return bending;
  const Eigen::ArrayXd in_plane =
      (amplitudes(ring.V_r).square() + amplitudes(ring.V_t).square()).sqrt();
  return bending + (in_plane * rates).sum();
}

}  // namespace chladni::squeal
