#include "squeal/cycle/cycle_of_all_modes.hpp"

#include <algorithm>

#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {
namespace {

/// Where the modes of `few` are among those of `all`: [n_all x n_few] of zeros and ones.
Eigen::MatrixXd selection(const Disc& few, const Disc& all)
{
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(all.n_modes(), few.n_modes());
  for (Eigen::Index j = 0; j < few.n_modes(); ++j) {
    const auto at =
        std::ranges::find(all.mode_numbers, few.mode_numbers[static_cast<std::size_t>(j)]);
    if (at != all.mode_numbers.end()) S(at - all.mode_numbers.begin(), j) = 1.0;
  }
  return S;
}

}  // namespace

Eigen::MatrixXd with_all_modes(const FlexibleDisc& few, const FlexibleDisc& all,
                               const Eigen::MatrixXd& x)
{
  const InertialDisc &a = few.inertial(), &b = all.inertial();
  // q = R a in both, and the columns of R are orthonormal.
  const Eigen::MatrixXd P = b.R.transpose() * selection(few.disc(), all.disc()) * a.R;
  const Eigen::Index n_few = a.n_modes(), n_all = b.n_modes(), half = x.rows() / 2,
                     n_pads = half - n_few, whole = n_all + n_pads;
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(2 * whole, x.cols());
  const Eigen::MatrixXd by_omega = a.omega.cwiseInverse().asDiagonal() * x.topRows(n_few);
  y.topRows(n_all) = b.omega.asDiagonal() * (P * by_omega);
  y.middleRows(n_all, n_pads) = x.middleRows(n_few, n_pads);
  y.middleRows(whole, n_all) = P * x.middleRows(half, n_few);
  y.bottomRows(n_pads) = x.bottomRows(n_pads);
  return y;
}

}  // namespace chladni::squeal
