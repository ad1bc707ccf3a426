#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace chladni::fmu {

/// A direction in which variables change.
struct Direction {
  std::span<const std::uint32_t> references;
  std::span<const double> changes;
};

/// What an FMU simulates, by the value references of its variables.
class Simulation {
 public:
  Simulation() = default;
  Simulation(const Simulation&) = default;
  Simulation& operator=(const Simulation&) = default;
  virtual ~Simulation() = default;

  /// As at the start of a simulation.
  virtual void reset() = 0;

  /// @throws chladni::Error for a reference that no variable has.
  virtual std::vector<double> values(std::span<const std::uint32_t> references) const = 0;
  /// @throws chladni::Error for a variable that is computed, and for what is no finite number.
  virtual void set_value(std::uint32_t reference, double value) = 0;
  virtual double time() const = 0;  ///< s
  virtual void set_time(double time) = 0;

  virtual Eigen::VectorXd continuous_states() const = 0;
  virtual void set_continuous_states(const Eigen::VectorXd& x) = 0;
  virtual Eigen::VectorXd derivatives() const = 0;

  /// Derivatives of the variables `unknowns` along changes of states and inputs.
  /// @throws chladni::Error for a change of what is neither, and where there are no derivatives.
  virtual std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                                      const Direction& direction) const = 0;

  /// Goes on by h > 0 seconds with the inputs as they are.
  virtual void advance(double h) = 0;

  /// All that changes in a simulation, and the way back to it.
  virtual Eigen::VectorXd snapshot() const = 0;
  virtual void restore(const Eigen::VectorXd& snapshot) = 0;
};

/// The simulation of this library's kind, out of the folder of an FMU's resources.
/// @param location  a path, or a URI with the scheme "file"
/// @param token     of modelDescription.xml
/// @throws chladni::Error when it cannot be read or is of another export.
std::unique_ptr<Simulation> simulation_at(const std::string& location, const std::string& token);

}  // namespace chladni::fmu
