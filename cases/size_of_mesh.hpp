#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace chladni::cases {

/// What an accuracy chooses of a mesh.
struct MeshSize {
  double size;                     ///< of its elements, m; of a .geo in its own sizes
  int order;                       ///< of its elements
  std::optional<double> edge_row;  ///< m
};

/// Whether the size of the elements can be chosen: with generators, .geo and .step.
bool has_size(const mesh::MeshOptions& mesh);
void set_size(mesh::MeshOptions& mesh, const MeshSize& size);
/// As it stands in the options.
int order_of(const mesh::MeshOptions& mesh);
std::optional<double> edge_row_of(const mesh::MeshOptions& mesh);

/// The orders to choose from beside that one.
std::vector<int> other_orders(const mesh::MeshOptions& mesh);
/// Whether the generator can put rows of this width along the edges.
bool takes_edge_row(const mesh::MeshOptions& mesh, double width);
/// m; of a .geo in its own sizes.
double largest_size(const mesh::MeshOptions& mesh);
/// To begin with: a few elements for each wave at omega (rad/s); of a .geo its own size.
double first_size(const scene::Scene& scene, double omega);

/// Two digits: ranks whose frequencies differ in the last bit choose the same.
double rounded(double size);
/// "element_order = 3, element_size = 0.031 m".
std::string described(const MeshSize& size);

/// Of the shells, m; infinite without one.
double least_thickness(const scene::Scene& scene);

}  // namespace chladni::cases
