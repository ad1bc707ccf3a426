#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

/// The compliance of all modes of `disc` without their inertia.
RingCompliance ring_compliance(const Disc& disc);

/// Shapes at all contact points side by side, and derivatives of the forces there, which act on
/// small motions as S (D_a S^T q + D_p S^T q').
struct StackedContact {
  Eigen::MatrixXd S;    ///< [n x m], m = rows of a point pair, one after the other
  Eigen::MatrixXd D_a;  ///< [m x m] by the motion
  Eigen::MatrixXd D_p;  ///< [m x m] by its rates
};

/// Zero shapes and derivatives of so many coordinates at the points of the pads.
StackedContact stacked_contact(const PadSystem& pads, Eigen::Index n);

/// Zero shapes, and the derivatives about the undeformed disc that slides at this speed (rad/s).
StackedContact contact_at_rest(const PadSystem& pads, Eigen::Index n, double speed);

/// Modes without inertia stand in series with the springs of the pads: a force f at the contact
/// points moves them by y = G f, and the pads feel the sum of this and of the motion u of the other
/// modes, f = F(u + y, u' + y'). For y' the force is linear in the motion and both pads of a pair
/// press; what is left out is of the order of (omega / omega_q)^2 and, for y', of n Omega / omega.
class ContactSeries {
 public:
  ContactSeries(const RingCompliance& rings, const PadSystem& pads, double speed);

  bool empty() const { return G_.size() == 0; }

  /// Derivatives by the motion of the other modes instead of by the whole one.
  void condense(StackedContact& contact) const;

  /// Adds y and y' to the motions of all points.
  /// @param force  (i, motion) -> the force at the point i, in the order of its rows
  template <class Force>
  void add_to(std::vector<PointMotion>& motions, const Force& force) const;

 private:
  Eigen::Index rows_;          ///< of a point
  Eigen::Index disc_rows_;     ///< of a point, those of the disc
  Eigen::MatrixXd G_;          ///< [disc_rows n_points x disc_rows n_points]
  Eigen::MatrixXd by_rate_;    ///< y' by u'
  Eigen::MatrixXd newton_;     ///< (I - D_a G)^-1 at rest
  Eigen::MatrixXd by_motion_;  ///< f by u, at rest
  double force_scale_ = 1.0;   ///< preload of the pads, N
};

template <class Force>
void ContactSeries::add_to(std::vector<PointMotion>& motions, const Force& force) const
{
  // Contraction by the part of the springs that another state of the contact takes away.
  constexpr int iterations_max = 60;
  constexpr double error = 1e-11;
  if (empty()) return;
  const auto n = static_cast<Eigen::Index>(motions.size());
  const Eigen::Index m = disc_rows_;
  Eigen::VectorXd u(m * n), u_dot(m * n), change(m * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    u.segment(m * i, m) = motions[static_cast<std::size_t>(i)].g.head(m);
    u_dot.segment(m * i, m) = motions[static_cast<std::size_t>(i)].g_dot.head(m);
  }
  u_dot += (by_rate_ * u_dot).eval();
  for (Eigen::Index i = 0; i < n; ++i)
    motions[static_cast<std::size_t>(i)].g_dot.head(m) = u_dot.segment(m * i, m);
  Eigen::VectorXd f = by_motion_ * u;
  for (int k = 0; k < iterations_max; ++k) {
    const Eigen::VectorXd whole = u + G_ * f;
    for (Eigen::Index i = 0; i < n; ++i) {
      PointMotion& at = motions[static_cast<std::size_t>(i)];
      at.g.head(m) = whole.segment(m * i, m);
      change.segment(m * i, m) =
          force(static_cast<std::size_t>(i), at).head(m) - f.segment(m * i, m);
    }
    if (change.lpNorm<Eigen::Infinity>() <= error * force_scale_) break;
    f += newton_ * change;
  }
}

}  // namespace chladni::squeal
