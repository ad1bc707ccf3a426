#pragma once

#include <string>
#include <utility>
#include <vector>

namespace chladni::plate {

/// Isotropic, linearly elastic.
struct Material {
  double young;    ///< Pa
  double poisson;  ///< -1 < nu < 0.5
  double density;  ///< kg/m^3
};

/// What a profile runs over: a coordinate of the model, or the distance from its z axis.
enum class Coordinate { x, y, z, radius };

/// A length that is constant, or linear between the points of a table and constant beyond its ends.
struct Profile {
  Coordinate over = Coordinate::x;
  std::vector<double> at;      ///< m, ascending; empty for a constant
  std::vector<double> values;  ///< m, as many as `at`; one for a constant

  Profile(double constant = 0.0) : values{constant} {}  // NOLINT(google-explicit-constructor)
  Profile(Coordinate coordinate, std::vector<double> points, std::vector<double> lengths)
      : over(coordinate), at(std::move(points)), values(std::move(lengths))
  {}
  bool operator==(const Profile&) const = default;
};

/// The shell section of one physical group.
struct ShellSection {
  std::string group;
  Material material;
  Profile thickness;     ///< m
  Profile offset = 0.0;  ///< m, from the mesh to the mid-surface along the normals of the elements
};

/// - rigid: a reference node at the centre of a group whose nodes follow it as a rigid body;
/// - link: each node of a group follows its nearest node in the group `to` as a rigid body, over
///   whatever gap is between them (a bell that ends at the face of a disc and its mid-surface);
/// - averaging: a reference node at the centre of a group that moves as the group does on average
///   and stiffens nothing: the translation and rotation that fit the displacements of its nodes
///   best in the mean square. Forces on it reach the nodes accordingly.
enum class CouplingKind { rigid, link, averaging };

struct Coupling {
  std::string name;   ///< of the reference node; a link has none
  std::string group;  ///< the nodes that are coupled
  CouplingKind kind = CouplingKind::rigid;
  std::string to = {};  ///< of a link
};

using RigidCoupling = Coupling;  ///< one of the kind that it has when none is given

}  // namespace chladni::plate
