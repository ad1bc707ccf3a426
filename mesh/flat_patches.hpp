#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "mesh/mesh_options.hpp"
#include "mesh/sweep.hpp"

/// What rectangles and pads have in common.
namespace chladni::mesh {

/// A plane surface with four edges: two at the ends of the profile, two at the ends of the path.
struct FourEdges {
  std::string surface;
  std::array<std::string, 4> edges;  ///< start and end of the profile, start and end of the path
  double start, end;                 ///< of the profile, m
  double length;                     ///< of the path, m
  std::function<std::array<double, 3>(const Station&, double t)> position;
  bool round = false;  ///< edges at the ends of the profile are arcs about the origin
};

struct PatchOptions {
  double element_size;
  int element_order;
  Pattern pattern;
  std::optional<double> edge_row;
};

FourEdges edges_of(const RectangleOptions& options);
FourEdges edges_of(const PadOptions& options);

PatchOptions patch_of(const auto& options)
{
  return {options.element_size, options.element_order, options.pattern, options.edge_row};
}

}  // namespace chladni::mesh
