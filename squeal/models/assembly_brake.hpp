#pragma once

#include <memory>
#include <vector>

#include "squeal/assembly/assembly.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// A disc that rotates between other modal bodies, for small motions about the sliding equilibrium.
/// Copies share the bodies.
class AssemblyBrake final : public Brake {
 public:
  explicit AssemblyBrake(Assembly assembly);

  const Assembly& assembly() const { return *assembly_; }

  Eigen::MatrixXd state_matrix(double speed) const override;
  /// The brake with another friction coefficient, or with another preload, stiffness or damping of
  /// every face.
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  /// The parameters of the brake's friction, and those of the faces that are equal for all faces.
  std::vector<ParameterValue> parameters() const override;
  /// Not available, because the contact is linear.
  /// @throws chladni::Error always.
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

 private:
  std::shared_ptr<const Assembly> assembly_;
  std::vector<Lining> linings_;
};

}  // namespace chladni::squeal
