#pragma once

#include <Eigen/Core>

#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake_options.hpp"

namespace chladni::squeal {

/// Static compliance of all modes of `disc` at its rings, averaged over all positions of the disc.
RingCompliance ring_compliance(const Disc& disc);

/// Shapes and force derivatives of all contact points, stacked. The contact force on small motions
/// is S (D_a S^T q + D_p S^T q').
struct StackedContact {
  Eigen::MatrixXd S;    ///< [n x m] shapes; m sums the rows of all point pairs
  Eigen::MatrixXd D_a;  ///< [m x m] derivatives by the motion
  Eigen::MatrixXd D_p;  ///< [m x m] derivatives by its rates
};

/// Zero shapes and derivatives for n coordinates at the contact points of the pads.
StackedContact stacked_contact(const PadSystem& pads, Eigen::Index n);

/// Zero shapes, with the force derivatives about the undeformed disc that slides at `speed`
/// (rad/s).
StackedContact contact_at_rest(const PadSystem& pads, Eigen::Index n, double speed);

/// Compliance of modes without inertia in series with the pad springs: a contact force f displaces
/// the contact points by y = G f, and the pads feel y plus the motion u of the other modes,
/// f = F(u + y, u' + y'). For y' the force is linearised with both pads of a pair in contact. The
/// neglected terms are of the order (omega / omega_q)^2 and, for y', n Omega / omega.
class ContactSeries {
 public:
  ContactSeries(const RingCompliance& rings, const PadSystem& pads, double speed);

  /// Whether there are no modes without inertia.
  bool empty() const { return G_.size() == 0; }

  /// Replaces the derivatives by the whole motion with those by the motion u of the other modes.
  void condense(StackedContact& contact) const;

  /// Adds y and y' to the motions u and u' of all points, by a fixed-point iteration for f.
  /// @param force  (i, motion) -> force at the point i, in the order of its rows
  template <class Force>
  void add_to(std::vector<PointMotion>& motions, const Force& force) const;

 private:
  Eigen::Index rows_;          ///< rows of a point pair
  Eigen::Index disc_rows_;     ///< rows of a point pair that belong to the disc
  Eigen::MatrixXd G_;          ///< [disc_rows n_points x disc_rows n_points] compliance
  Eigen::MatrixXd by_rate_;    ///< derivative of y' by u'
  Eigen::MatrixXd newton_;     ///< (I - D_a G)^-1 at rest
  Eigen::MatrixXd by_motion_;  ///< derivative of f by u, at rest
  double force_scale_ = 1.0;   ///< largest preload of the pads, N
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

/// Linearised contact of all pads about the sliding equilibrium. Modes of pads with a mass follow
/// those of the disc.
/// @param speed  rad/s, > 0
StackedContact linear_contact(const InertialDisc& disc, const PadSystem& pads, double speed);

/// State matrix A of x' = A x about the sliding equilibrium a = 0 with x = (diag(omega) a, p). All
/// entries have the unit 1/s, so that the eigenvalue problem is well scaled. Modes of pads with a
/// mass follow at the end of a and p.
/// @param speed  rad/s, > 0
/// @return [2 n x 2 n], n = n_modes + modes of the pads, 1/s
Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed);

}  // namespace chladni::squeal
