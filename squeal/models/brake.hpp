#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "squeal/motion/autonomous_motion.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

class Brake;
class FlexibleDisc;
class LumpedBrake;

/// A number of a brake that is no MapParameter: a point of a friction table, a spring of a joint,
/// the frequency of a mode.
struct BrakeNumber {
  std::string key;   ///< of the scene, or a name such as "frequency of the mode at 870 Hz"
  std::string unit;  ///< of the value
  double value;
  double step;  ///< a small change of the value, by which to take differences; 0: a part of it
  /// The brake with another value, in the same coordinates; valid while the brake lives.
  std::function<std::unique_ptr<Brake>(double value)> with;
};

/// A of x' = A x about the sliding equilibrium, at a speed (rad/s).
using StateMatrixAt = std::function<Eigen::MatrixXd(double speed)>;

/// Whatever squeals: all that an analysis needs to know of it, whatever it is made of.
class Brake {
 public:
  Brake() = default;
  Brake(const Brake&) = default;
  Brake& operator=(const Brake&) = default;
  virtual ~Brake() = default;

  /// Whether its equations do not depend on time in some frame: without that there is neither a
  /// state matrix nor a periodic motion.
  virtual bool is_autonomous() const { return true; }

  /// A of x' = A x about the sliding equilibrium x = 0. The entries have the unit 1/s when x is
  /// scaled to energy, e.g. (omega q, q').
  /// @param speed  rad/s, > 0
  /// @throws chladni::Error with the reason when the brake is not autonomous.
  virtual Eigen::MatrixXd state_matrix(double speed) const = 0;

  /// The same brake with one parameter at another value, for all its pads if it is one of pads.
  virtual std::unique_ptr<Brake> with(MapParameter parameter, double value) const = 0;

  /// The parameters that it has, with those of each pad pair by itself, and their values.
  virtual std::vector<ParameterValue> parameters() const { return {}; }

  /// All other numbers on which its small motions depend.
  virtual std::vector<BrakeNumber> further_numbers() const { return {}; }

  /// x' = f(x; speed) with switching contact, for the search of periodic motions.
  /// @throws chladni::Error with the reason when there is none.
  virtual std::unique_ptr<AutonomousMotion> motion(double speed) const = 0;

  /// Compression of the first pad spring at rest: the displacement at which it would let go, m.
  virtual double rest_compression() const = 0;

  /// This brake with its modal body, for what only a body has: mode shapes, the influence of single
  /// modes, stability in the rotating frame, a choice of integrators, snapshots. Null without one.
  virtual const FlexibleDisc* body() const { return nullptr; }

  /// This brake as a few equations that a transient integrates; null where the modes of a body take
  /// their place.
  virtual const LumpedBrake* lumped() const { return nullptr; }
};

/// `state_matrix` over the speed; keeps a reference to the brake.
inline StateMatrixAt state_matrix_at(const Brake& brake)
{
  return [&brake](double speed) { return brake.state_matrix(speed); };
}

}  // namespace chladni::squeal
