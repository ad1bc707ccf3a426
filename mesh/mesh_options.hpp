#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace chladni::mesh {

/// Nodes at equal angles exactly on a circle about the z axis, beginning on the x axis.
struct RingOptions {
  std::string name;
  double radius;  ///< m
  int nodes;
  std::optional<double> z = {};  ///< m; needed where several surfaces meet the cylinder
};

/// How a generator lays out its elements.
enum class Pattern {
  structured,    ///< rows and columns of quadrilaterals; every row of a disc is a circle
  unstructured,  ///< quadrilaterals by Gmsh, with triangles where they would be flat
  triangles      ///< by Gmsh
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
  std::optional<double> edge_row = {};  ///< m, width of one row of elements along both edges
  int sectors = 1;                      ///< equal ones, of which one is meshed; structured only
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
  double top_radius;    ///< m, where it meets the flange
  double hub_radius;    ///< m, inner edge of the flange
  double height;        ///< m, of the flange above the ring
  double foot;          ///< m, of the wall's lower edge above the ring; 0 = joined to it
  double element_size;  ///< m
  int element_order = 3;
  std::vector<RingOptions> rings;  ///< on the ring-shaped disc
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, along the edges of disc and hub and around bolts
  std::optional<BoltOptions> bolts = {};
  int sectors = 1;  ///< equal ones, of which one is meshed; structured only
};

/// Plane sector of an annulus about the z axis, symmetric to `centre_angle`: a pad. Groups: "pad"
/// (surface), "inner_edge", "outer_edge", "first_edge" (of the least angle), "last_edge",
/// "corners".
struct PadOptions {
  double inner_radius;      ///< m
  double outer_radius;      ///< m
  double angle;             ///< rad, < pi
  double centre_angle = 0;  ///< rad
  double element_size;      ///< m
  int element_order = 3;
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, along all four edges
};

/// Plane rectangle from the origin along x and y. Groups: "plate" (surface), "left", "right",
/// "bottom", "top", "corners".
struct RectangleOptions {
  double length;        ///< m, along x
  double width;         ///< m, along y
  double element_size;  ///< m
  int element_order = 3;
  Pattern pattern = Pattern::structured;
  std::optional<double> edge_row = {};  ///< m, along all four edges
};

/// A named node of a generated beam.
struct BeamPoint {
  std::string name;
  double distance;  ///< from the start, m
};

/// Straight line of two-node elements from start to end. Groups: "beam" (the line), "start", "end"
/// and one for each point.
struct BeamMeshOptions {
  std::array<double, 3> start;              ///< m
  std::array<double, 3> end;                ///< m
  std::optional<int> elements = {};         ///< of equal length; each point must meet a node
  std::optional<double> element_size = {};  ///< m, largest; each piece between points is divided
  std::vector<BeamPoint> points = {};
};

/// What becomes of nodes of unconnected elements of a file that stand at one place.
enum class Coincident { refuse, merge, keep };

/// Whether a body that repeats about the z axis is reduced from one sector of its mesh.
enum class SectorSearch {
  none,
  where_nothing_is_lost,  ///< of the errors and the section forces that the whole body would have
  asked
};

/// A group of the points, curves or surfaces of a file's geometry.
struct EntityGroup {
  std::string name;
  std::vector<std::string> entities;  ///< "surface_3", "curve_1", "point_2", or labels of the file
};

/// What Gmsh may do while it reads a file.
enum class Trust {
  stranger,  ///< in a process of its own that starts no program and writes no file
  owner      ///< whatever the file says: a .geo may run programs and write files
};

/// The scene's [mesh]: exactly one generator or a file.
struct MeshOptions {
  std::optional<AnnulusOptions> annulus = {};
  std::optional<HatDiscOptions> hat_disc = {};
  std::optional<PadOptions> pad = {};
  std::optional<RectangleOptions> rectangle = {};
  std::optional<BeamMeshOptions> beam = {};
  /// .msh, .geo, .step or of another program, resolved against the scene file's folder; the rest is
  /// about the file.
  std::optional<std::string> file = {};
  std::optional<int> element_order = {};    ///< not of a .msh, which has its own
  std::optional<double> element_size = {};  ///< m; of a .step, else as Gmsh likes
  double size_factor = 1.0;                 ///< of the element sizes that a .geo says
  std::vector<std::pair<std::string, double>> parameters = {};  ///< of a .geo, in its own unit
  double length_unit = 1.0;                   ///< m; what 1 is in the file; a .step tells it itself
  std::vector<EntityGroup> groups = {};       ///< besides those of the file
  std::vector<RingOptions> rings = {};        ///< nodes must lie there; a .step gets them
  std::vector<std::string> line_groups = {};  ///< of curves whose elements become lines
  /// Of surfaces with a section; in files whose elements may be of several groups, these count.
  std::vector<std::string> shell_groups = {};
  int sectors = 1;  ///< equal ones, of which the file holds one
  SectorSearch sector_search = SectorSearch::none;
  Coincident coincident_nodes = Coincident::refuse;
  std::optional<double> merge_tolerance = {};  ///< m
  Trust trust = Trust::stranger;               ///< never from the scene, which comes with the mesh
  std::optional<double> most_seconds = {};     ///< for Gmsh to read a stranger's file
  std::optional<int> most_MiB = {};            ///< of memory, for the same
};

}  // namespace chladni::mesh
