#pragma once

#include <memory>
#include <vector>

#include "squeal/assembly/assembly.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// A disc that turns between other modal bodies, in small motions about the sliding equilibrium.
/// Copies share the bodies.
class AssemblyBrake final : public Brake {
 public:
  explicit AssemblyBrake(Assembly assembly);

  const Assembly& assembly() const { return *assembly_; }

  Eigen::MatrixXd state_matrix(double speed) const override;
  /// Friction, or preload, stiffness and damping of every face.
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  /// Those of the friction of the brake, and those of faces which all of them share.
  std::vector<ParameterValue> parameters() const override;
  /// @throws chladni::Error: contact is linear here.
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

 private:
  std::shared_ptr<const Assembly> assembly_;
  std::vector<Lining> linings_;
};

}  // namespace chladni::squeal
