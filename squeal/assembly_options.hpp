#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"

namespace chladni::squeal {

/// A modal body of an assembly and its position in the brake.
struct PartOptions {
  std::string name;
  std::string body;                  ///< body file, relative to the folder of the results
  std::array<double, 3> position{};  ///< position of the origin of its mesh, m
  std::array<double, 3> rotation{};  ///< successive rotations about x, y, z of the brake, rad
};

/// A set of attachment nodes of a part; for the ground the part's name is empty.
struct PartNodes {
  std::string part;
  std::string set;

  bool is_ground() const { return part.empty(); }
};

/// A joint between two sets of nodes, or between a set and the ground, node by node. Components 0,
/// 1, 2 are displacements along x, y, z of the brake and 3, 4, 5 rotations about these axes.
struct JointOptions {
  std::array<PartNodes, 2> ends;  ///< the first end is a part
  std::vector<int> rigid;         ///< components of a rigid joint; empty: springs
  /// For a rigid joint without a list of components: rotations about the normal of a smooth shell
  /// remain free.
  bool spares_drilling = false;
  std::array<double, 6> stiffness{};  ///< stiffness for each pair of nodes, N/m or N m
  std::array<double, 6> damping{};    ///< damping for each pair of nodes, N s/m or N m s
  double span = 0.0;                  ///< largest allowed distance of two joined nodes, m
};

/// A property of a whole face, or per unit of its area.
struct FaceQuantity {
  double value;
  bool per_area = false;
};

/// How the properties of a face are distributed over its nodes.
enum class NodeShares {
  by_area,  ///< by the area that is nearer to the node than to any other
  equal
};

/// A lining between the nodes of a part and the contact plane of the disc: a massless elastic layer
/// that transmits compression only.
struct FaceContact {
  PartNodes face;
  /// Height of the nodes above the contact plane: half the plate plus the lining; or 0, m.
  double height;
  FaceQuantity stiffness;     ///< N/m, or N/m^3
  FaceQuantity damping{0.0};  ///< N s/m, or N s/m^3
  FaceQuantity preload;       ///< N, or Pa
  NodeShares shares = NodeShares::by_area;
  std::optional<FrictionLaw> friction = {};  ///< absent: the friction of the brake
};

/// A disc that rotates between other modal bodies: [[part]], [[joint]] and [[contact]] of a scene.
struct AssemblyOptions {
  std::vector<PartOptions> parts;
  std::vector<JointOptions> joints;
  std::vector<FaceContact> contacts;
  std::string disc;                ///< name of the part that rotates about the z axis of the brake
  std::vector<std::string> rings;  ///< rings of the disc whose radii enclose the faces
  double thickness;                ///< distance of the two contact planes, m
  /// z of the lower and the upper contact plane, m. Absent: half the thickness below and above the
  /// rings, which then lie in the middle surface of a plate; its in-plane displacements do not act
  /// on the pads.
  std::optional<std::array<double, 2>> planes = {};
  std::vector<std::string> slopes_from = {};  ///< see SquealOptions
  FrictionLaw friction;
  /// Whether the material of the disc moves under the parts. If false, the matrices are those of a
  /// disc at rest with sliding friction, as many finite-element programs assume.
  bool convection = true;
};

}  // namespace chladni::squeal
