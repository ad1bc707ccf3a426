#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "squeal/assembly/assembly.hpp"
#include "squeal/assembly_options.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// A number of the scene of an assembly.
struct AssemblyNumber {
  std::string key;   ///< of the scene: "joint[2].stiffness.z", "part[3].position[1]"
  std::string unit;  ///< of its value
  double value;
  double step;  ///< a change of the value that is small but above rounding; 0: a part of the value
  std::function<void(AssemblyOptions& options, double value)> set;
};

/// Every number of parts, joints, linings and disc on which small motions depend, but for the keys
/// of the brake's own friction law, which are parameters of every brake: places and rotations of
/// parts, stiffness and damping of joints (those that are not zero), height, stiffness, damping,
/// preload and own friction of linings, thickness or contact planes, points of friction tables.
std::vector<AssemblyNumber> assembly_numbers(const AssemblyOptions& options);

/// A disc that rotates between other modal bodies, for small motions about the sliding equilibrium.
/// Copies share the bodies.
class AssemblyBrake final : public Brake {
 public:
  /// @param bodies  of the parts, in their order
  /// @throws chladni::Error as `assembly`.
  AssemblyBrake(const AssemblyOptions& options, std::span<const mbs_export::ModalBody> bodies);

  const Assembly& assembly() const { return *assembly_; }

  Eigen::MatrixXd state_matrix(double speed) const override;
  /// The brake with another friction coefficient, or with another preload, stiffness or damping of
  /// every face.
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  /// The parameters of the brake's friction, and those of the faces that are equal for all faces.
  std::vector<ParameterValue> parameters() const override;
  /// `assembly_numbers`, and the frequencies of the modes of disc and parts. Left out are places
  /// and rotations that rigid joints do not allow to change one by one.
  std::vector<BrakeNumber> further_numbers() const override;
  /// Not available, because the contact is linear.
  /// @throws chladni::Error always.
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

 private:
  /// Of what it was made.
  struct Source {
    AssemblyOptions options;
    std::vector<mbs_export::ModalBody> bodies;
  };

  std::unique_ptr<Brake> of(Assembly assembly) const;
  BrakeNumber number_of(AssemblyNumber number) const;
  void add_frequencies(std::vector<BrakeNumber>& numbers) const;
  /// @param row  of the part's mode in `Assembly::X`
  BrakeNumber frequency_of(const std::string& part, Eigen::Index mode, double omega,
                           Eigen::Index row) const;

  std::shared_ptr<const Source> source_;
  std::shared_ptr<const Assembly> assembly_;
  std::vector<Lining> linings_;
};

}  // namespace chladni::squeal
