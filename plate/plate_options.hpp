#pragma once

#include <string>
#include <vector>

namespace chladni::plate {

/// Isotropic, linearly elastic.
struct Material {
  double young;    ///< Pa
  double poisson;  ///< -1 < nu < 0.5
  double density;  ///< kg/m^3
};

/// The shell section of one physical group.
struct ShellSection {
  std::string group;
  Material material;
  double thickness;  ///< m
};

/// A reference node at the centre of a group whose nodes follow it as a rigid body.
struct RigidCoupling {
  std::string name;   ///< of the reference node
  std::string group;  ///< the dependent nodes
};

}  // namespace chladni::plate
