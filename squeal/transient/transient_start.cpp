#include "squeal/transient/transient_start.hpp"

#include <cmath>

namespace chladni::squeal {
namespace {

/// a_cos = a_sin in the first pair, turned so that the crest of the cosine is at `angle`; at rest
/// in the inertial frame, i.e. a' = 0, p = Omega D a. Pairs in the plane do not move the pads.
ModalState start_in_first_pair(const InertialDisc& disc, const TransientCase& run, double angle)
{
  Eigen::VectorXd a = Eigen::VectorXd::Zero(disc.n_modes());
  const Eigen::VectorXd& U = disc.rings.front().U;
  const double still = 1e-3 * U.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < disc.n_modes(); ++i) {
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 && std::abs(U[i]) > still &&
        (disc.nodal_diameters[static_cast<std::size_t>(first)] == 0 ||
         std::abs(U[first]) <= still || disc.omega[i] < disc.omega[first]))
      first = i;
  }
  const bool pair = disc.nodal_diameters[static_cast<std::size_t>(first)] > 0;
  a.segment(first, pair ? 2 : 1).setConstant(run.initial_pad_displacement / U[first]);
  const Eigen::VectorXd at_pad = turned(disc, a, angle);
  return {disc.R * at_pad, disc.R * (run.speed * disc.D * at_pad)};
}

}  // namespace

ModalState transient_start(const Disc& disc, const std::optional<InertialDisc>& inertial,
                           const TransientCase& run, double angle)
{
  if (inertial) return start_in_first_pair(*inertial, run, angle);
  const Eigen::VectorXd W = shapes_at(disc, angle).W;
  return {W * (run.initial_pad_displacement / W.squaredNorm()),
          Eigen::VectorXd::Zero(disc.n_modes())};
}

}  // namespace chladni::squeal
