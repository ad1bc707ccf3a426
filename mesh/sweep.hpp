#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// A point, m, of the plane in which profiles are drawn; for a body of revolution (radius, z).
using Station = std::array<double, 2>;

/// A polyline of element edges that sweeps a surface.
struct Profile {
  std::string group;              ///< of the surface
  std::vector<Station> stations;  ///< ends of its elements; profiles join where these are equal
};

/// The path along which profiles are swept, in `n_elements` elements.
struct Path {
  int n_elements;
  bool closed;  ///< true if it ends where it begins
  int order;    ///< of the elements
  /// The position, m, of a station at t in [0, 1] along the path.
  std::function<std::array<double, 3>(const Station&, double t)> position;
};

/// A structured mesh and its rows of nodes.
struct Swept {
  Mesh mesh;
  /// First node of the row that a station sweeps.
  std::map<Station, int> first_node;
  int n_columns;  ///< number of nodes of a row, along the path
};

/// Sweeps profiles along a path: quadrilaterals of `path.order` in rows (along the path) and
/// columns (along the profiles). The normal of the elements is that of (profile direction) x (path
/// direction).
Swept sweep(std::span<const Profile> profiles, const Path& path);

/// Adds the row of a station as a group of curves.
void add_row_group(Swept& swept, const Station& station, const std::string& name);

/// Adds column `k` of the path as a group of curves.
void add_column_group(Swept& swept, int k, const std::string& name);

/// Ascending numbers that divide each interval of `breaks` into equal parts of about `size`.
std::vector<double> cut(const std::vector<double>& breaks, double size);

/// Checks that two rows of the width `row` fit between two edges at `distance`, m.
/// @throws chladni::Error when they do not.
void check_edge_rows(double row, double distance);

/// Adds to `breaks` one number at the distance `row` inside each end.
/// @throws chladni::Error as `check_edge_rows`.
std::vector<double> with_edge_rows(std::vector<double> breaks, double row);

/// The number of elements around a circle of `radius`: its length over `size`, at least 12 (a cubic
/// edge of 90 degrees folds its element over), rounded so that each node of each ring is a corner
/// and all sectors have the same number.
/// @throws chladni::Error when rings and sectors need more than four times that number.
int n_elements_around(double radius, double size, std::span<const RingOptions> rings,
                      int sectors = 1);

}  // namespace chladni::mesh
