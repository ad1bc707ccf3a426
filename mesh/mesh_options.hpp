#pragma once

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

/// The scene's [mesh]: exactly one of the two.
struct MeshOptions {
  std::optional<AnnulusOptions> annulus;
  std::optional<std::string> file;   ///< .msh or .geo, resolved against the scene file's folder
  std::optional<int> element_order;  ///< for .geo; a .msh has its own
  std::vector<RingOptions> rings;    ///< of a file: nodes that must lie on a circle; checked
};

}  // namespace chladni::mesh
