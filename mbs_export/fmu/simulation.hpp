#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace chladni::fmu {

/// A change of several variables, for directional derivatives.
struct Direction {
  std::span<const std::uint32_t> references;
  std::span<const double> changes;
};

/// The system that an FMU simulates, accessed by the value references of its variables.
class Simulation {
 public:
  Simulation() = default;
  Simulation(const Simulation&) = default;
  Simulation& operator=(const Simulation&) = default;
  virtual ~Simulation() = default;

  /// Returns to the state at the start of a simulation.
  virtual void reset() = 0;

  /// Values of the variables.
  /// @throws chladni::Error for a reference that no variable has.
  virtual std::vector<double> values(std::span<const std::uint32_t> references) const = 0;
  /// Sets an input, a parameter or a state.
  /// @throws chladni::Error for a computed variable, and for a value that is not finite.
  virtual void set_value(std::uint32_t reference, double value) = 0;
  virtual double time() const = 0;  ///< s
  virtual void set_time(double time) = 0;

  virtual Eigen::VectorXd continuous_states() const = 0;
  virtual void set_continuous_states(const Eigen::VectorXd& x) = 0;
  virtual Eigen::VectorXd derivatives() const = 0;

  /// Derivatives of the variables `unknowns` along a change of states and inputs.
  /// @throws chladni::Error when `direction` changes another kind of variable, and when the FMU
  ///         provides no derivatives.
  virtual std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                                      const Direction& direction) const = 0;

  /// Advances by h > 0 (s) with constant inputs.
  virtual void advance(double h) = 0;

  /// All that changes during a simulation, as one vector for `restore`.
  virtual Eigen::VectorXd snapshot() const = 0;
  /// Returns to the state of a snapshot.
  virtual void restore(const Eigen::VectorXd& snapshot) = 0;
};

/// Reads the simulation of this library's kind from the resources folder of an FMU.
/// @param location  a path, or a URI with the scheme "file"
/// @param token     token of modelDescription.xml
/// @throws chladni::Error when the model cannot be read or comes from another export.
std::unique_ptr<Simulation> simulation_at(const std::string& location, const std::string& token);

}  // namespace chladni::fmu
