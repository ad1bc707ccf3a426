#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Isotropic and linearly elastic.
struct DeclaredMaterial {
  std::string name;
  double young;    ///< Pa
  double poisson;  ///< of the shear modulus too
  double density;  ///< kg/m^3
};

/// The shell section of one group.
struct DeclaredShell {
  std::string group, material;
  double thickness;  ///< m
  double offset;     ///< m, from the nodes to the mid-surface along the normals of the elements
};

/// The beam section of one group, in axes as a scene's: z towards `orientation`.
struct DeclaredBeam {
  std::string group = {}, material = {};
  double area, I_y, I_z, J;                   ///< m^2, m^4
  std::optional<double> shear_factor_y = {};  ///< absent: rigid in shear
  std::optional<double> shear_factor_z = {};
  std::optional<std::array<double, 3>> orientation = {};  ///< needed unless y and z are alike
};

/// A reference node that moves with the nodes of a group: as a rigid body with them, or as they do
/// in the mean.
struct DeclaredCoupling {
  std::string name, group;
  bool averages;
};

/// Components of the nodes of a group, or of a coupling's reference node, that are held.
struct DeclaredSupport {
  std::string group;
  std::vector<int> components;  ///< 0 to 5, ascending
};

/// A rigid body on the node of a group or the reference node of a coupling.
struct DeclaredMass {
  std::string at;
  double mass;                    ///< kg
  std::array<double, 6> inertia;  ///< as a scene's: xx, yy, zz, xy, xz, yz, kg m^2
  std::array<double, 3> offset;   ///< of the centre of mass, m
};

/// Between two such nodes, or one and the ground.
struct DeclaredSpring {
  std::string at;
  std::optional<std::string> to = {};  ///< absent: the ground
  std::array<double, 6> stiffness;     ///< N/m, N m/rad
};

/// What a file of another FE program says besides its mesh, in SI units.
struct Declarations {
  std::vector<DeclaredMaterial> materials;
  std::vector<DeclaredShell> shells;
  std::vector<DeclaredBeam> beams;
  std::vector<DeclaredCoupling> couplings;
  std::vector<DeclaredSupport> supports;
  std::vector<DeclaredMass> masses;
  std::vector<DeclaredSpring> springs;
  std::vector<std::string> notes;  ///< for the user: what becomes something else here
};

/// What 1 is in a deck whose masses follow from its forces and seconds.
struct DeckUnits {
  double length;  ///< m
  double force;   ///< N

  double stress() const { return force / (length * length); }      ///< Pa
  double density() const { return stress() / (length * length); }  ///< kg/m^3
  double mass() const { return force / length; }                   ///< kg, of N s^2/m
  double moment_of_inertia() const { return mass() * area(); }     ///< kg m^2
  double area() const { return length * length; }                  ///< m^2
  double second_moment() const { return area() * area(); }         ///< m^4
};

/// What the deck says besides its mesh, read where strangers' files are read.
/// @param options  `file` is a deck; its `length_unit` is not looked at
/// @throws chladni::Error naming file, line and card of what is wrong or has no counterpart here.
Declarations declarations(const MeshOptions& options, const DeckUnits& units);

}  // namespace chladni::mesh
