#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/friction.hpp"
#include "squeal/model_options.hpp"
#include "squeal/motion/motion.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

class Brake;
class FlexibleDisc;
class LumpedBrake;

/// A number of a brake that is no MapParameter: a spring of a joint, the frequency of a mode.
struct BrakeNumber {
  std::string key;   ///< of the scene, or a name such as "frequency of the mode at 870 Hz"
  std::string unit;  ///< of the value
  double value;
  double step;  ///< a small change of the value, by which to take differences; 0: a part of it
  /// The brake with another value, in the same coordinates; valid while the brake lives.
  std::function<std::unique_ptr<Brake>(double value)> with;
  /// dA / d value at a speed (rad/s), where it is known without a difference; else empty.
  std::function<Eigen::MatrixXd(double speed)> derivative = {};
};

/// State matrix A of x' = A x about the sliding equilibrium as a function of the speed (rad/s).
using StateMatrixAt = std::function<Eigen::MatrixXd(double speed)>;

/// A brake as the analyses see it, independent of its model.
class Brake {
 public:
  Brake() = default;
  Brake(const Brake&) = default;
  Brake& operator=(const Brake&) = default;
  virtual ~Brake() = default;

  /// Whether the equations are independent of time in some frame. Otherwise there is neither a
  /// state matrix nor a periodic motion.
  virtual bool is_autonomous() const { return true; }

  /// State matrix A of x' = A x about the sliding equilibrium x = 0. The entries have the unit 1/s
  /// when x is scaled by energy, as (omega q, q') is.
  /// @param speed  rad/s, > 0
  /// @throws chladni::Error with the reason when the brake is not autonomous.
  virtual Eigen::MatrixXd state_matrix(double speed) const = 0;

  /// A copy of the brake with another value of one parameter; a pad parameter is set for all pads
  /// unless it names one.
  /// @throws chladni::Error when the brake does not have the parameter.
  virtual std::unique_ptr<Brake> with(MapParameter parameter, double value) const = 0;

  /// All parameters of the brake with their values; pad parameters are listed for each pad pair.
  virtual std::vector<ParameterValue> parameters() const { return {}; }

  /// All other numbers on which its small motions depend.
  virtual std::vector<BrakeNumber> further_numbers() const { return {}; }

  /// The motion x' = f(x; speed) with switching contact, for the search of periodic motions.
  /// @throws chladni::Error with the reason when there is none.
  virtual std::unique_ptr<AutonomousMotion> motion(double speed) const = 0;

  /// Compression of the first pad's spring at rest, m; at this displacement the pad would lose
  /// contact.
  virtual double rest_compression() const = 0;

  /// The brake with its modal body, for analyses that need one: mode shapes, influence of single
  /// modes, stability in the rotating frame, choice of integrators. Null for other
  /// brakes.
  virtual const FlexibleDisc* body() const { return nullptr; }

  /// The brake as a few differential equations for a transient; null for a brake with a modal body.
  virtual const LumpedBrake* lumped() const { return nullptr; }
};

/// The state matrix as a function of the speed; keeps a reference to the brake.
inline StateMatrixAt state_matrix_at(const Brake& brake)
{
  return [&brake](double speed) { return brake.state_matrix(speed); };
}

/// A brake without a modal body: a few autonomous differential equations x' = f(x; speed) with the
/// sliding equilibrium at x = 0.
class LumpedBrake : public Brake {
 public:
  const LumpedBrake* lumped() const override { return this; }

  /// Number of entries of x.
  virtual Eigen::Index size() const = 0;

  /// The rate f(x; speed).
  /// @param speed  rad/s
  virtual Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const = 0;

  /// Contact state of the first pad pair at x.
  virtual ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const = 0;

  /// The state at rest in which the first pads have a given displacement (m).
  virtual Eigen::VectorXd start(double displacement) const = 0;

  /// Height z of the first upper pad at x = 0, m.
  virtual double rest_height() const = 0;
};

/// The frequency (Hz) of each mode or pair of modes of a disc. With another frequency a mode keeps
/// its damping in 1/s.
/// @param disc   must live as long as the numbers
/// @param brake  the brake with another disc in place of this one
std::vector<BrakeNumber> disc_frequencies(
    const InertialDisc& disc, const std::function<std::unique_ptr<Brake>(InertialDisc)>& brake);

/// The brake of a scene whose model has no mesh.
/// @param bodies  bodies of the parts of an assembly, in their order
/// @throws chladni::Error as `assembly`.
std::unique_ptr<Brake> model_brake(const ModelOptions& options,
                                   std::span<const mbs_export::ModalBody> bodies = {});

}  // namespace chladni::squeal
