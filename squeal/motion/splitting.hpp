#pragma once

#include <Eigen/Core>

#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake_options.hpp"

namespace chladni::squeal {

/// Modal coordinates and their rates.
struct ModalState {
  Eigen::VectorXd q;  ///< [n_modes]
  Eigen::VectorXd v;  ///< [n_modes] q'
};

/// Several modal states, one in each column.
struct ModalColumns {
  Eigen::MatrixXd q;  ///< [n_modes x n]
  Eigen::MatrixXd v;  ///< [n_modes x n]
};

/// The exact flow of q'' + C q' + diag(omega^2) q = 0 over a fixed time.
class OscillatorFlow {
 public:
  /// @param omega  [n_modes] rad/s
  /// @param C      [n_modes x n_modes] 1/s
  /// @param time   s
  OscillatorFlow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time);

  void advance(ModalState& x) const;
  void advance(ModalColumns& x) const;

 private:
  bool coupled_;
  Eigen::MatrixXd flow_;  ///< [2 n x 2 n] matrix exponential of coupled equations
  /// 2 x 2 blocks of the matrix exponential for uncoupled equations.
  Eigen::ArrayXd qq_, qv_, vq_, vv_;
};

/// Angle and speed of the disc, and preload of the pads.
struct Turn {
  double angle;          ///< rad
  double speed;          ///< rad/s
  double preload = 1.0;  ///< factor on the preload of all pads
};

/// Angle, speed and preload at time t (s) by the programs of a transient. Speed and preload are
/// linear between the points of their programs and constant before the first and after the last
/// point; without a program they are constant.
Turn turn_at(const TransientCase& run, double t);

/// Factor on the preload at time t (s): linear between the points of the preload program, constant
/// before the first and after the last point; 1 without a program.
double preload_at(const TransientCase& run, double t);

/// Contact forces of all pads on a rotating disc and on plates with a mass, and their kick in the
/// Strang splitting. Coordinates are the modes of the disc, then those of the pads.
class ContactKick {
 public:
  ContactKick(const Disc& disc, const SquealOptions& options, double speed);

  /// Integrates v' = Q(q, v, t) with q and t constant over `step` (s) by the explicit midpoint
  /// rule. Q includes the Coriolis terms of the disc.
  /// @return contact states at the midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& apply(ModalState& x, const Turn& turn, double step);

  /// The kick at time t (s) of a disc at constant speed.
  const std::vector<ContactResult<double>>& apply(ModalState& x, double t, double step)
  {
    return apply(x, Turn{speed_ * t, speed_}, step);
  }

  const PadSystem& pads() const { return pads_; }

  /// Linearised contact stiffness at the angle of the last kick, [n x n] 1/s^2.
  Eigen::MatrixXd contact_stiffness() const;

 private:
  /// Q at the rates `v` with the present shapes.
  const Eigen::VectorXd& force(const Eigen::VectorXd& v);

  /// Changes the preload. The motion is measured from the sliding equilibrium with this preload.
  /// @param preload  factor on the preload of all pads
  void press(double preload);

  double speed_;          ///< speed at the last kick, rad/s
  double first_speed_;    ///< speed of the sliding equilibrium, rad/s
  double preload_ = 1.0;  ///< preload factor at the last kick
  Eigen::MatrixXd G_;     ///< Coriolis matrix of the disc; see Disc
  PointShapes shapes_;
  PadSystem pads_;
  std::vector<BrakePoint> points_;  ///< present shapes; contact at rest at the first speed
  std::vector<PairVector<double>> position_;  ///< present motion of each point
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<ContactResult<double>> contacts_;  ///< of each point at the last evaluation
  std::vector<ContactResult<double>> of_pads_;   ///< of each pad pair at the last kick
  Eigen::VectorXd Q_;
  Eigen::VectorXd v_mid_;
};

/// Time steps of an axisymmetric disc in the inertial frame, x = (diag(omega) a, p), by Strang
/// splitting. The linearised sliding disc is integrated exactly, x(t + h) = exp(h A) x(t); the
/// nonlinear remainder of the pad forces is a kick of p by the explicit midpoint rule between two
/// halves of this flow. Growth and decay of small motions are exact for any step; the error of
/// large motions is of second order.
class ExponentialFlow {
 public:
  /// @param step  step size h, s
  ExponentialFlow(const InertialDisc& disc, const SquealOptions& options, double speed,
                  double step);

  /// Size of x, including the modes of the pads.
  Eigen::Index size() const { return half_.rows(); }

  /// Advances by half a step of the flow, for the first and the last step.
  void advance_half(Eigen::VectorXd& x) const { x = (half_ * x).eval(); }
  /// Advances by a whole step of the flow.
  void advance(Eigen::VectorXd& x);

  /// Applies the kick of a whole step.
  /// @return contact states at its midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& kick(Eigen::VectorXd& x);

 private:
  /// A contact point with its shapes divided by the frequencies.
  struct Point {
    BrakePoint at;
    PairShapes S_by_omega;
  };

  /// Adds `factor` times the nonlinear remainder of the forces at the rates `p` to `to`.
  void add_remainders(const Eigen::VectorXd& p, double factor, Eigen::Ref<Eigen::VectorXd> to);

  double speed_;
  double step_;
  Eigen::MatrixXd half_, whole_;
  PadSystem pads_;
  std::vector<Point> points_;
  std::vector<PairVector<double>> position_;
  ContactSeries series_;
  StackedContact linear_;  ///< linear part of the forces
  std::vector<PointMotion> motions_;
  Eigen::VectorXd linear_force_;
  std::vector<ContactResult<double>> contacts_;  ///< of each point at the last evaluation
  std::vector<ContactResult<double>> of_pads_;   ///< of each pad pair at the last kick
  Eigen::VectorXd next_, p_mid_;
};

}  // namespace chladni::squeal
