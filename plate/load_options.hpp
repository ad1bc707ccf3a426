#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

namespace chladni::plate {

/// Components of the motion that are held at zero at every node of a group or ring, or at the
/// reference node of a coupling.
struct Support {
  std::string group;
  std::vector<int> components;  ///< 0 to 5: x, y, z, rx, ry, rz
};

/// A force and a moment that the nodes of a group or ring share equally, or that act on the
/// reference node of a coupling.
struct NodalLoad {
  std::string group;
  std::array<double, 3> force{};   ///< N, of all nodes together
  std::array<double, 3> moment{};  ///< N m, of all nodes together
};

/// A force per length on the element edges whose nodes all belong to a group.
struct EdgeLoad {
  std::string group;
  std::array<double, 3> line_force;  ///< N/m
};

/// A pressure on the elements of a group in the direction of their normals (from the first axis of
/// an element to its second, right-handed).
struct PressureLoad {
  std::string group;
  double pressure;  ///< Pa
};

/// The weight of the body in a gravity field: f = M a.
struct GravityLoad {
  std::array<double, 3> acceleration;  ///< m/s^2, in the direction of the fall
};

using Load = std::variant<NodalLoad, EdgeLoad, PressureLoad, GravityLoad>;

}  // namespace chladni::plate
