#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chladni::mesh {

/// How a mesh file is read.
enum class MeshSource { msh, geo, step, unv, med, nastran, abaqus, ansys };

/// A kind of mesh file, by what its name ends with, in letters of either case.
struct FileKind {
  std::string_view extension;
  MeshSource source;
  std::string_view program;  ///< or format, as people call it
};

/// All kinds of mesh files.
inline constexpr std::array<FileKind, 12> file_kinds{{{".msh", MeshSource::msh, "Gmsh"},
                                                      {".geo", MeshSource::geo, "Gmsh"},
                                                      {".step", MeshSource::step, "STEP"},
                                                      {".stp", MeshSource::step, "STEP"},
                                                      {".unv", MeshSource::unv, "universal files"},
                                                      {".med", MeshSource::med, "MED"},
                                                      {".mmed", MeshSource::med, "MED"},
                                                      {".bdf", MeshSource::nastran, "Nastran"},
                                                      {".nas", MeshSource::nastran, "Nastran"},
                                                      {".dat", MeshSource::nastran, "Nastran"},
                                                      {".inp", MeshSource::abaqus, "Abaqus"},
                                                      {".cdb", MeshSource::ansys, "Ansys"}}};

/// How a mesh file of this name is read; nothing if it is none by its name.
inline std::optional<MeshSource> mesh_source(std::string_view file)
{
  const auto is_same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  };
  for (const auto& [extension, source, program] : file_kinds) {
    if (file.size() <= extension.size()) continue;
    if (std::ranges::equal(file.substr(file.size() - extension.size()), extension, is_same))
      return source;
  }
  return std::nullopt;
}

/// True for a deck of another FE program. It has sections and does not tell its unit of length.
constexpr bool is_deck(MeshSource source)
{
  return source == MeshSource::nastran || source == MeshSource::abaqus ||
         source == MeshSource::ansys;
}
inline bool is_deck(std::string_view file)
{
  const auto source = mesh_source(file);
  return source && is_deck(*source);
}

/// True for a format that carries meshes with groups between programs. Such files give no reliable
/// unit of length and no sections.
constexpr bool is_exchange(MeshSource source)
{
  return source == MeshSource::unv || source == MeshSource::med;
}
inline bool is_exchange(std::string_view file)
{
  const auto source = mesh_source(file);
  return source && is_exchange(*source);
}

/// The extensions of the kinds for which `holds` does: ".msh, .geo, ... or .inp".
inline std::string extensions_of(bool (*holds)(MeshSource) = [](MeshSource) { return true; })
{
  std::vector<std::string_view> found;
  for (const FileKind& kind : file_kinds)
    if (holds(kind.source)) found.push_back(kind.extension);
  std::string text;
  for (std::size_t i = 0; i < found.size(); ++i)
    text.append(i == 0 ? "" : i + 1 < found.size() ? ", " : " or ").append(found[i]);
  return text;
}

/// The extensions of those kinds, with program or format: ".msh, .geo (Gmsh), ... .cdb (Ansys)".
inline std::string extensions_with_programs(bool (*holds)(MeshSource) = [](MeshSource) {
  return true;
})
{
  std::string text;
  for (std::size_t i = 0; i < file_kinds.size(); ++i) {
    const FileKind& kind = file_kinds[i];
    if (!holds(kind.source)) continue;
    text.append(text.empty() ? "" : ", ").append(kind.extension);
    if (i + 1 == file_kinds.size() || file_kinds[i + 1].program != kind.program)
      text.append(" (").append(kind.program).append(")");
  }
  return text;
}

/// What to do with a mesh file of version 0.2 that is read no more; empty for other names.
inline std::string instead_of(std::string_view file)
{
  if (!file.ends_with(".vtu")) return "";
  return "; meshio makes a .msh of a .vtu, and lines of docs/how-to/meshes.md keep its groups";
}

/// What has the nodes of a ring.
enum class RingOn {
  nodes,  ///< nodes of the mesh stand at its places
  face    ///< it has nodes of its own, which follow the faces of solids
};

/// Nodes at equal angles on a circle about the z axis, the first on the x axis.
struct RingOptions {
  std::string name;
  double radius;  ///< m
  int nodes;
  std::optional<double> z = {};  ///< m; needed where several surfaces meet the cylinder
  RingOn on = RingOn::nodes;
  double width = 0.0;  ///< m, of the patch of faces whose mean a node is; 0: a point
};

/// The layout of the elements of a generator.
enum class Pattern {
  structured,    ///< rows and columns of quadrilaterals; every row of a disc is a circle
  unstructured,  ///< quadrilaterals by Gmsh, with triangles where they would have a flat corner
  triangles      ///< triangles by Gmsh
};

/// Plane annular disc about the z axis. Groups: "disc" (surface), "inner_edge", "outer_edge" and
/// one for each ring.
struct AnnulusOptions {
  double inner_radius;  ///< m
  double outer_radius;  ///< m
  double element_size;  ///< m
  int element_order = 3;
  std::vector<RingOptions> rings;
  Pattern pattern = Pattern::unstructured;
  std::optional<double> edge_row = {};  ///< m, width of a row of elements along both edges
  int sectors = 1;  ///< number of equal sectors, of which one is meshed; structured only
};

/// Round holes at equal angles on a circle of the flange, the first on the x axis.
struct BoltOptions {
  int count;
  double circle_radius;  ///< m
  double hole_radius;    ///< m
};

/// Disc with hat: a plane ring at z = 0, a wall (cylinder or cone) that rises from it, and a flange
/// that closes it to the hub. Groups: surfaces "disc", "wall", "flange"; circles "outer_edge",
/// "hub_edge", "wall_seat" (of the disc), "inner_edge" where the disc reaches inside the wall,
/// "wall_foot" where the wall ends above the disc; "bolt_edges" and "bolt_1", ...; the rings.
struct HatDiscOptions {
  double inner_radius;  ///< m, of the ring; at most wall_radius
  double outer_radius;  ///< m
  double wall_radius;   ///< m, where the wall meets the ring
  double top_radius;    ///< m, where the wall meets the flange
  double hub_radius;    ///< m, inner edge of the flange
  double height;        ///< m, from the ring to the flange
  double foot;          ///< m, from the ring to the wall's lower edge; 0 = joined to it
  double element_size;  ///< m
  int element_order = 3;
  std::vector<RingOptions> rings;  ///< on the plane ring
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, width along edges of disc and hub, around bolts
  std::optional<BoltOptions> bolts = {};
  int sectors = 1;  ///< number of equal sectors, of which one is meshed; structured only
};

/// A pad: a plane sector of an annulus about the z axis, symmetric to `centre_angle`. Groups: "pad"
/// (surface), "inner_edge", "outer_edge", "first_edge" (at the least angle), "last_edge",
/// "corners".
struct PadOptions {
  double inner_radius;      ///< m
  double outer_radius;      ///< m
  double angle;             ///< rad, < pi
  double centre_angle = 0;  ///< rad
  double element_size;      ///< m
  int element_order = 3;
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, width of a row along all four edges
};

/// Plane rectangle from the origin along x and y. Groups: "plate" (surface), "left", "right",
/// "bottom", "top", "corners".
struct RectangleOptions {
  double length;        ///< m, along x
  double width;         ///< m, along y
  double element_size;  ///< m
  int element_order = 3;
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, width of a row along all four edges
};

/// A named node of a generated beam.
struct BeamPoint {
  std::string name;
  double distance;  ///< from the start, m
};

/// A straight line from start to end. Groups: "beam" (the line), "start",
/// "end" and one for each point.
struct BeamMeshOptions {
  std::array<double, 3> start;       ///< m
  std::array<double, 3> end;         ///< m
  std::optional<int> elements = {};  ///< number of equal elements; each point must meet a node
  std::optional<double> element_size = {};  ///< m, largest; pieces between points are divided
  std::vector<BeamPoint> points = {};
  int element_order = 1;
};

/// What happens to nodes of unconnected elements of a file that stand at one place.
enum class Coincident { refuse, merge, keep };

/// What happens to elements of a deck that have the same nodes as another one of their type.
enum class Doubled {
  refuse,
  merge,  ///< the first one stands for all
  keep    ///< their stiffness and mass add up
};

/// Whether a body that is periodic about the z axis is reduced from one sector of its mesh.
enum class SectorSearch {
  none,                   ///< never
  where_nothing_is_lost,  ///< if error estimates and section forces stay those of the whole body
  asked                   ///< the scene asks for it
};

/// A group of points, curves or surfaces of a file's geometry.
struct EntityGroup {
  std::string name;
  std::vector<std::string> entities;  ///< "surface_3", "curve_1", "point_2", or labels of the file
};

/// What a file may do while Gmsh reads it.
enum class Trust {
  stranger,  ///< read in a process of its own that starts no program and writes no file
  owner      ///< anything: a .geo may run programs and write files
};

/// A place, and the largest size of elements there.
struct SizeAt {
  std::array<double, 3> x;  ///< m
  double size;              ///< m
};

/// Solids over a plane mesh.
struct Extrusion {
  double from, to;  ///< m, heights; from < to
  int layers = 1;
};

inline constexpr double pound_force = 4.4482216152605;  // N

/// Files with the matrices of another program for the nodes of a mesh file.
struct MatrixFiles {
  std::string stiffness, mass;
  std::optional<std::string> damping = {}, structural_damping = {};
  std::optional<std::string> dofs = {};  ///< the node and component of each row; some tell it
  double force_unit = 1.0;               ///< N per unit of force of the files
};

/// The table [mesh] of a scene: exactly one generator or a file.
struct MeshOptions {
  std::optional<AnnulusOptions> annulus = {};
  std::optional<HatDiscOptions> hat_disc = {};
  std::optional<PadOptions> pad = {};
  std::optional<RectangleOptions> rectangle = {};
  std::optional<BeamMeshOptions> beam = {};
  std::optional<Extrusion> extrude = {};  ///< of an annulus, pad or rectangle
  /// A .msh, .geo, .step or a file of another program, resolved against the folder of the scene
  /// file. All further members are about the file.
  std::optional<std::string> file = {};
  std::optional<int> element_order = {};    ///< for a .geo or .step; others are raised to it
  std::optional<double> element_size = {};  ///< m, for a .step; absent: Gmsh's choice
  double size_factor = 1.0;                 ///< on the sizes of a .geo; others are halved
  std::vector<SizeAt> sizes = {};           ///< for a .geo or .step: smaller elements there
  std::vector<std::pair<std::string, double>> parameters = {};  ///< for a .geo, in its own units
  double length_unit = 1.0;                   ///< m per unit of the file; a .step states its unit
  std::vector<EntityGroup> groups = {};       ///< in addition to those of the file
  std::vector<RingOptions> rings = {};        ///< the file has nodes there; a .step gets them
  std::vector<std::string> line_groups = {};  ///< groups of curves that become line elements
  /// Groups of surfaces with a section. They decide where an element is in several groups.
  std::vector<std::string> shell_groups = {};
  std::vector<std::string> solid_groups = {};  ///< groups of volumes with a section
  /// Groups of rigid couplings and links, whose nodes stay although no element has them.
  std::vector<std::string> coupled_groups = {};
  std::optional<MatrixFiles> matrices = {};  ///< instead of sections
  int sectors = 1;  ///< number of equal sectors, of which the file holds one
  SectorSearch sector_search = SectorSearch::none;
  Coincident coincident_nodes = Coincident::refuse;
  Doubled doubled_elements = Doubled::refuse;  ///< of a deck
  std::optional<double> merge_tolerance = {};  ///< m
  std::optional<std::string> cache = {};    ///< folder in which meshes are kept, of generators too
  Trust trust = Trust::stranger;            ///< never set by the scene, which comes with the mesh
  std::optional<double> most_seconds = {};  ///< s, time limit for reading a stranger's file
  std::optional<int> most_MiB = {};         ///< MiB, memory limit for reading a stranger's file
};

}  // namespace chladni::mesh
