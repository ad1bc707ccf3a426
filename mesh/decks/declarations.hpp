#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// An isotropic linearly elastic material.
struct DeclaredMaterial {
  std::string name;
  double young;    ///< Pa
  double poisson;  ///< also defines the shear modulus
  double density;  ///< kg/m^3
};

/// The shell section of a group.
struct DeclaredShell {
  /// Values between which a length is linear over a coordinate, as in a scene.
  struct Table {
    std::string over;
    std::vector<double> at, values;  ///< m
  };
  std::string group, material;
  double thickness;                 ///< m
  std::optional<Table> table = {};  ///< takes the place of the thickness
  /// m, from the nodes to the mid-surface, along the normals of the elements
  double offset;
};

/// The beam section of a group. Its axes are those of a scene: z points towards `orientation`.
struct DeclaredBeam {
  std::string group = {}, material = {};
  double area, I_y, I_z, J;  ///< m^2, m^4
  /// Absent: rigid in shear.
  std::optional<double> shear_factor_y = {};
  std::optional<double> shear_factor_z = {};
  /// Needed unless the section is the same in y and z.
  std::optional<std::array<double, 3>> orientation = {};
};

/// The solid section of a group.
struct DeclaredSolid {
  std::string group, material;
};

/// The kinds of couplings of a scene that decks have.
enum class CouplingOfDeck { rigid, averaging };

/// A reference node coupled to the nodes of a group, or a group that follows another node.
struct DeclaredCoupling {
  std::string name = {};  ///< of the reference node; empty with `to`
  std::string group;
  CouplingOfDeck kind;
  std::string to = {};  ///< group of one node, or coupling, that the nodes follow
  std::optional<std::array<double, 3>> at = {};  ///< m; absent with `to`
};

/// Held components of the nodes of a group, or of the reference node of a coupling.
struct DeclaredSupport {
  std::string group;
  std::vector<int> components;  ///< 0 to 5, ascending
};

/// A rigid body at the node of a group or at the reference node of a coupling.
struct DeclaredMass {
  std::string at;  ///< group or coupling
  double mass;     ///< kg
  /// kg m^2; xx, yy, zz, xy, xz, yz as in a scene
  std::array<double, 6> inertia;
  std::array<double, 3> offset;  ///< m, from the node to the centre of mass
};

/// A spring between two nodes, each of a group or a coupling, or between one node and the ground.
struct DeclaredSpring {
  std::string at;                      ///< group or coupling
  std::optional<std::string> to = {};  ///< absent: the ground
  std::array<double, 6> stiffness;     ///< 3 in N/m, 3 in N m/rad
};

/// The contents of a file of another FE program besides its mesh, in SI units.
struct Declarations {
  std::vector<DeclaredMaterial> materials;
  std::vector<DeclaredShell> shells;
  std::vector<DeclaredBeam> beams;
  std::vector<DeclaredSolid> solids;
  std::vector<DeclaredCoupling> couplings;
  std::vector<DeclaredSupport> supports;
  std::vector<DeclaredMass> masses;
  std::vector<DeclaredSpring> springs;
  /// For the user: what is represented by something else in a scene.
  std::vector<std::string> notes;

  /// Whether a section is of the group.
  bool has_section(const std::string& group) const;
  /// Whether a section is of the material.
  bool uses(const std::string& material) const;
  /// Adds a material of a section; a note tells of one without a density.
  /// @param place  file and line
  void add(const DeclaredMaterial& material, const std::string& place);
};

/// The units of length and force of a deck in SI. Its unit of mass follows from that of force and
/// the second.
struct DeckUnits {
  double length;  ///< m per unit of the deck
  double force;   ///< N per unit of the deck

  double stress() const { return force / (length * length); }      ///< Pa
  double density() const { return stress() / (length * length); }  ///< kg/m^3
  /// kg, since it is N s^2/m
  double mass() const { return force / length; }
  double moment_of_inertia() const { return mass() * area(); }  ///< kg m^2
  double area() const { return length * length; }               ///< m^2
  double second_moment() const { return area() * area(); }      ///< m^4
};

/// Reads the contents of a deck besides its mesh. A stranger's file is read in a process of its
/// own.
/// @param options  `file` is a deck; `length_unit` is ignored
/// @throws chladni::Error naming file, line and card of a mistake, or of anything that a scene
///         cannot express.
Declarations declarations(const MeshOptions& options, const DeckUnits& units);

}  // namespace chladni::mesh
