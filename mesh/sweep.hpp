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

/// A point of the plane in which profiles are drawn; (radius, z) of a body of revolution.
using Station = std::array<double, 2>;

/// A line of straight elements that sweeps a surface.
struct Profile {
  std::string group;              ///< of the surface
  std::vector<Station> stations;  ///< ends of its elements; profiles join where these are equal
};

/// The way of the profiles, cut into `n_elements`.
struct Path {
  int n_elements;
  bool closed;  ///< it ends where it begins
  int order;    ///< of the elements
  /// Where a station is at t in [0, 1] of the way, m.
  std::function<std::array<double, 3>(const Station&, double t)> position;
};

/// A structured mesh and its rows of nodes.
struct Swept {
  Mesh mesh;
  std::map<Station, int> first_node;  ///< of the row that an end of an element sweeps
  int n_columns;                      ///< nodes of a row, along the path
};

/// Quadrilaterals of `path.order` in rows (along the path) and columns (along the profiles). Seen
/// against their normals profile and path turn as x and y.
Swept sweep(std::span<const Profile> profiles, const Path& path);

/// Adds the row of a station as a group of curves.
void add_row_group(Swept& swept, const Station& station, const std::string& name);

/// Adds column `k` of the path as a group of curves.
void add_column_group(Swept& swept, int k, const std::string& name);

/// Ascending numbers that cut each interval of `breaks` into equal parts of about `size`.
std::vector<double> cut(const std::vector<double>& breaks, double size);

/// @throws chladni::Error when two rows of this width do not fit between two edges.
void check_edge_rows(double row, double distance);

/// `breaks` with one more at distance `row` inside both ends.
/// @throws chladni::Error as check_edge_rows.
std::vector<double> with_edge_rows(std::vector<double> breaks, double row);

/// Elements around a circle of `radius`: about its length over `size`, at least 12 (a cubic edge of
/// 90 degrees folds its element over), with a corner at each node of each ring, as many in each of
/// the sectors.
/// @throws chladni::Error when rings and sectors ask for more than four times that.
int n_elements_around(double radius, double size, std::span<const RingOptions> rings,
                      int sectors = 1);

}  // namespace chladni::mesh
