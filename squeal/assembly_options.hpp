#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"

namespace chladni::squeal {

/// A modal body of an assembly, and where it stands in the brake.
struct PartOptions {
  std::string name;
  std::string body;                  ///< file, as seen from the folder of the results
  std::array<double, 3> position{};  ///< of the origin of its mesh, m
  std::array<double, 3> rotation{};  ///< about x, then y, then z of the brake, rad
};

/// A set of attachment nodes of a part; the ground has no name.
struct PartNodes {
  std::string part;
  std::string set;

  bool is_ground() const { return part.empty(); }
};

/// What joins two sets of nodes, or one set and the ground, node by node. Components are 0, 1, 2 =
/// displacement along x, y, z of the brake and 3, 4, 5 = rotation about them.
struct JointOptions {
  std::array<PartNodes, 2> ends;  ///< the first one is a part's
  std::vector<int> rigid;         ///< components that both ends share; empty: springs
  /// Of a rigid joint without a choice of components: rotations about the normal of a smooth shell
  /// stay free.
  bool spares_drilling = false;
  std::array<double, 6> stiffness{};  ///< of each pair of nodes, N/m or N m
  std::array<double, 6> damping{};    ///< of each pair of nodes, N s/m or N m s
  double span = 0.0;                  ///< that two nodes may be apart and are joined over, m
};

/// A property of a whole face, or of each square metre of it.
struct FaceQuantity {
  double value;
  bool per_area = false;
};

/// What part of a face each of its nodes stands for.
enum class NodeShares {
  by_area,  ///< the area that is nearer to it than to any other node
  equal
};

/// A lining between the nodes of a part and the contact plane of the disc that they face: an
/// elastic layer that resists compression alone and has no mass.
struct FaceContact {
  PartNodes face;
  double height;  ///< of the nodes above the contact plane: half of the plate and the lining, m
  FaceQuantity stiffness;     ///< N/m, or N/m^3
  FaceQuantity damping{0.0};  ///< N s/m, or N s/m^3
  FaceQuantity preload;       ///< N, or Pa
  NodeShares shares = NodeShares::by_area;
  std::optional<FrictionLaw> friction = {};  ///< absent: that of the brake
};

/// A disc that turns between other modal bodies: [[part]], [[joint]] and [[contact]] of a scene.
struct AssemblyOptions {
  std::vector<PartOptions> parts;
  std::vector<JointOptions> joints;
  std::vector<FaceContact> contacts;
  std::string disc;                ///< the part that turns, about the z axis of the brake
  std::vector<std::string> rings;  ///< of the disc, over whose radii the faces lie
  double thickness;                ///< distance of the two contact planes, m
  /// z of the lower and the upper contact plane, m; absent: half the thickness on both sides of the
  /// rings, which lie in the middle surface of a plate then, whose displacements in its plane no
  /// pad feels.
  std::optional<std::array<double, 2>> planes = {};
  std::vector<std::string> slopes_from = {};  ///< as in SquealOptions
  FrictionLaw friction;
  /// Whether the disc moves under the parts as it turns: without, friction slides over a disc whose
  /// matrices stand still, as many finite-element programs have it.
  bool convection = true;
};

}  // namespace chladni::squeal
