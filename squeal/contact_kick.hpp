#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/contact.hpp"
#include "squeal/disc.hpp"
#include "squeal/oscillator_flow.hpp"
#include "squeal/ring_shapes.hpp"

namespace chladni::squeal {

/// The contact forces of all pads on a rotating disc, and their kick in the Strang splitting.
class ContactKick {
 public:
  ContactKick(const Disc& disc, const SquealOptions& options, double speed);

  /// v' = Q(q, v, t) with q and t frozen, over `step` (s) by the explicit midpoint rule.
  /// @return the contacts at the midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& apply(ModalState& x, double t, double step);

 private:
  /// Q at the rates `v` with the shapes of this instant.
  const Eigen::VectorXd& force(const Eigen::VectorXd& v);

  double speed_;
  RingShapes ring_;
  std::vector<PadContact> pads_;
  std::vector<double> angles_;
  std::vector<Eigen::MatrixX3d> shapes_;         ///< of each pad at this instant
  std::vector<Eigen::Vector3d> position_;        ///< (w, g_r, g_t) of each pad at this instant
  std::vector<ContactResult<double>> contacts_;  ///< of each pad at the last force
  Eigen::VectorXd Q_;
  Eigen::VectorXd v_mid_;
};

}  // namespace chladni::squeal
