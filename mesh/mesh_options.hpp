#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mesh {

/// Nodes at equal angles exactly on a circle about the z axis, beginning on the x axis.
struct RingOptions {
  std::string name;
  double radius;  ///< m
  int nodes;
};

/// Plane annular disc about the z axis. Groups: "disc" (surface), "inner_edge", "outer_edge" and
/// one for each ring.
struct AnnulusOptions {
  double inner_radius;  ///< m
  double outer_radius;  ///< m
  double element_size;  ///< m
  int element_order = 3;
  std::vector<RingOptions> rings;
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

/// The scene's [mesh]: exactly one of the generators and the file.
struct MeshOptions {
  std::optional<AnnulusOptions> annulus;
  std::optional<std::string> file;   ///< .msh or .geo, resolved against the scene file's folder
  std::optional<int> element_order;  ///< for .geo; a .msh has its own
  std::vector<RingOptions> rings;    ///< of a file: nodes that must lie on a circle; checked
  std::optional<BeamMeshOptions> beam = {};
  /// Of a file: groups of curves whose elements become blocks of lines.
  std::vector<std::string> line_groups = {};
};

}  // namespace chladni::mesh
