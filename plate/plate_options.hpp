#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace chladni::plate {

/// An isotropic, linearly elastic material with structural damping: E (1 + i eta) in harmonic
/// motion.
struct Material {
  double young;              ///< Pa
  double poisson;            ///< -1 < nu < 0.5
  double density;            ///< kg/m^3
  double loss_factor = 0.0;  ///< eta >= 0
};

/// The variable of a profile: a coordinate of the model, or the distance from its z axis.
enum class Coordinate { x, y, z, radius };

/// A length that depends on the position: constant, linear between the points of a table and
/// constant beyond its ends, or a formula.
struct Profile {
  Coordinate over = Coordinate::x;
  std::vector<double> at;      ///< m, ascending; empty for a constant
  std::vector<double> values;  ///< m, as many as `at`; one for a constant
  std::string formula;         ///< of x, y, z, radius (m) and angle (rad); empty without one
  /// rad; a place has the value of the place turned by this angle about the z axis
  double turned = 0.0;

  Profile(double constant = 0.0) : values{constant} {}  // NOLINT(google-explicit-constructor)
  Profile(Coordinate coordinate, std::vector<double> points, std::vector<double> lengths)
      : over(coordinate), at(std::move(points)), values(std::move(lengths))
  {}
  static Profile by_formula(std::string text)
  {
    Profile profile;
    profile.formula = std::move(text);
    return profile;
  }
  bool operator==(const Profile&) const = default;
};

/// The shell section of a physical group.
struct ShellSection {
  std::string group;
  Material material;
  Profile thickness;     ///< m
  Profile offset = 0.0;  ///< m, from the mesh to the mid-surface along the normals of the elements
  /// eta >= 0, replaces that of the material
  std::optional<double> loss_factor = {};
};

/// The material of a physical group of solids.
struct SolidSection {
  std::string group;
  Material material;
  std::optional<double> loss_factor = {};  ///< eta >= 0, replaces that of the material
};

enum class BeamTheory { bernoulli_euler, timoshenko };

/// The beam section of a physical group of lines. Local axes: x along the line, z as near to
/// `orientation` as a right angle to x allows, y = z x x. Centroid and shear centre are on the
/// line.
struct BeamSection {
  std::string group;
  Material material;
  BeamTheory theory = BeamTheory::timoshenko;
  double area;                          ///< m^2
  double I_y;                           ///< int z^2 dA, bending in the x-z plane, m^4
  double I_z;                           ///< int y^2 dA, bending in the x-y plane, m^4
  double J;                             ///< torsion constant, m^4
  double shear_factor_y = 5.0 / 6.0;    ///< kappa of kappa G A for shear along y
  double shear_factor_z = 5.0 / 6.0;    ///< the same for shear along z
  bool has_rotary_inertia = true;       ///< rho I_y and rho I_z of the bending rotations
  std::optional<std::array<double, 3>>  ///< needed unless y and z are alike
      orientation = {};
  std::optional<double> loss_factor = {};  ///< eta >= 0, replaces that of the material
};

/// A rigid body at each node of a group, or at the reference node of a coupling.
struct PointMass {
  std::string at;
  double mass;  ///< kg
  /// xx, yy, zz, xy, xz, yz about the centre of mass, kg m^2; xy = -int x y dm and so on
  std::array<double, 6> inertia = {};
  std::array<double, 3> offset = {};  ///< m, from the node to the centre of mass
};

/// A massless spring and damper for each component in the global axes, between the node of a group
/// or coupling and another node or the ground. Between two nodes at a distance the forces act at
/// the midpoint, so that rigid motion causes none.
struct Spring {
  std::string at;
  /// Absent: the ground; then each node of the group has a spring of its own.
  std::optional<std::string> to = {};
  std::array<double, 6> stiffness = {};  ///< N/m, N m/rad
  std::array<double, 6> damping = {};    ///< N s/m, N m s/rad
  double loss_factor = 0.0;              ///< eta >= 0 of the stiffness
};

/// The sections, masses and springs of a body.
struct Structure {
  std::span<const ShellSection> shells = {};
  std::span<const BeamSection> beams = {};
  std::span<const SolidSection> solids = {};
  std::span<const PointMass> masses = {};
  std::span<const Spring> springs = {};
};

/// The kinds of couplings:
/// - rigid: a reference node, at the centre of a group unless `at` says where, whose motion the
///   nodes of the group follow as a rigid body. With `to` there is no reference node: they follow
///   the one node of that group, or the reference node of that coupling;
/// - link: each node of a group follows its nearest node in the group `to` as a rigid body, across
///   any gap between them (a bell that ends at the face of a disc and its mid-surface);
/// - averaging: a reference node, at the centre of a group unless `at` says where, that moves as
/// the
///   group does on average and adds no stiffness: its translation and rotation are the
///   least-squares fit to the displacements of the nodes, weighted with the length or area of each.
///   Forces on it reach the nodes as an even traction.
enum class CouplingKind { rigid, link, averaging };

/// A coupling of the nodes of a group.
struct Coupling {
  std::string name;   ///< of the reference node; empty where there is none (`to`)
  std::string group;  ///< the nodes that are coupled
  CouplingKind kind = CouplingKind::rigid;
  std::string to = {};  ///< of a link: group that is followed; of a rigid one: or a coupling
  std::optional<std::array<double, 3>> at = {};  ///< m; absent: the centre of the nodes

  bool has_reference_node() const { return to.empty(); }
};

/// A ring of nodes whose circumferential harmonics 0 .. `up_to` become coordinates.
struct RingHarmonics {
  std::string ring;
  int up_to;  ///< 1 .. floor(N / 2) for N nodes
};

/// The couplings, components and harmonic rings that define how the nodes of a body can move.
struct Kinematics {
  std::span<const Coupling> couplings = {};
  std::vector<int> components = {0, 1, 2, 3, 4, 5};  ///< ascending; the others are held at zero
  std::span<const RingHarmonics> rings = {};
};

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
/// an element to its second, right-handed), or on the faces of solids whose nodes are all in the
/// group, into the body.
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
