#pragma once

#include <Eigen/Core>

#include <array>
#include <complex>
#include <functional>
#include <optional>

#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// Cardan angles q_1 (about the inertial x axis) and q_2 (about the tilted y axis), their rates,
/// and the spin about the disc's axis.
template <class Scalar>
struct RigidMotion {
  Eigen::Vector2<Scalar> q;      ///< rad
  Eigen::Vector2<Scalar> q_dot;  ///< rad/s
  Scalar spin;                   ///< rad/s
};

/// State of one pad of the rigid disc.
template <class Scalar>
struct RigidPad {
  Scalar z;                  ///< height of the contact point on the pad axis, m
  Scalar z_dot;              ///< velocity of the pad, m/s
  Scalar S;                  ///< axial force of the pad, N
  Scalar S_free;             ///< axial force of a pad that could also pull, N
  Scalar N;                  ///< normal force, N
  Scalar slip_speed;         ///< |v_r|, m/s
  Eigen::Vector3<Scalar> F;  ///< force on the disc, inertial axes, N; F_z = -sigma S
};

/// Accelerations of the rigid disc and the forces that cause them.
template <class Scalar>
struct RigidAcceleration {
  Eigen::Vector2<Scalar> q_ddot;  ///< rad/s^2
  Scalar spin_rate;               ///< rad/s^2, zero for Drive::speed
  Scalar moment;                  ///< moment M_A of the drive, N m
  RigidPad<Scalar> upper;
  RigidPad<Scalar> lower;
};

/// The nonlinear equations of motion. `Scalar` is double, or complex for derivatives.
template <class Scalar>
RigidAcceleration<Scalar> accelerate(const RigidDisc& disc, const RigidMotion<Scalar>& motion,
                                     Drive drive);

/// The nonlinear equations with the upper and the lower pad on given branches of the contact law;
/// see contact_branch.hpp.
template <class Scalar>
RigidAcceleration<Scalar> accelerate_on_branches(const RigidDisc& disc,
                                                 const RigidMotion<Scalar>& motion, Drive drive,
                                                 const std::array<double, 2>& branches);

/// Matrices of the linearised equations M q'' + C q' + K q = 0.
struct RigidMatrices {
  Eigen::Matrix2d M;  ///< kg m^2
  Eigen::Matrix2d C;  ///< N m s
  Eigen::Matrix2d K;  ///< N m
};

/// The linearised equations at `speed` (rad/s, > 0) in closed form, for a constant friction
/// coefficient. They are the same for both drives.
RigidMatrices rigid_disc_matrices(const RigidDisc& disc, double speed);

/// The linearised equations from derivatives of `accelerate` at rest by complex steps, exact to
/// rounding.
/// @param speed  rad/s, > 0
RigidMatrices linearised(const RigidDisc& disc, Drive drive, double speed);

/// The state matrix A of x' = A x with x = (omega q, q'), omega^2 = tr K / tr M.
Eigen::MatrixXd first_order(const RigidMatrices& matrices);

/// The two eigenvalues with Im > 0 by ascending frequency: growth rate 1/s + i rad/s.
Eigen::Vector2cd eigenvalues(const RigidMatrices& matrices);

/// The rigid disc with x = (w q, q'), w^2 = k_t / Theta. Drive::moment adds a fifth entry, the
/// deviation of the spin from the speed (rad/s), which is constant in the linearised equations.
/// These have no periodic motion to search for.
class RigidDiscBrake final : public LumpedBrake {
 public:
  explicit RigidDiscBrake(const RigidDiscStudy& study) : study_(study) {}

  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override;
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

  Eigen::Index size() const override { return study_.drive == Drive::moment ? 5 : 4; }
  Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const override;
  ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const override;
  Eigen::VectorXd start(double displacement) const override;
  double rest_height() const override { return 0.5 * study_.disc.thickness; }

 private:
  RigidDiscStudy study_;
};

}  // namespace chladni::squeal
