#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The mesh of the scene, with its rings. The elements of a file that has its own are split as
/// `set_split` asks. With `accuracy` its groups of nodes that hold whole edges of elements are
/// groups of these edges, so that finer elements are held and loaded all along them.
/// @throws chladni::Error as `mesh::generate`.
mesh::Mesh mesh_scene(const scene::Scene& scene);

/// What becomes of the elements of a file that has its own.
struct Split {
  std::optional<int> order = {};  ///< that they get
  int halvings = 0;               ///< of their size
};

/// The elements of a mesh, raised to an order and then halved.
mesh::Mesh split(mesh::Mesh mesh, const Split& into);

/// Asks `mesh_scene` for elements that are split.
void set_split(mesh::MeshOptions& mesh, const Split& into);

/// Checks that the mesh has all groups of the scene.
/// @throws chladni::Error naming file, line and key of a group that it lacks.
void check_groups(const scene::Scene& scene, const mesh::Mesh& mesh);

/// A note where the shells of a mesh with all groups of the scene hold more than 3 % of their mass
/// twice, by ribs that end on the mid-surfaces of plates.
std::optional<std::string> note_of_overlap(const scene::Scene& scene, const mesh::Mesh& mesh);

/// Returns a part of a mesh, or all of it.
using ChooseMesh = std::function<mesh::Mesh(mesh::Mesh)>;

/// Makes the mesh on the first rank and sends it to all ranks.
/// @param choose  the part to be sent; called on the first rank
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, also as `check_groups`.
mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene, const ChooseMesh& choose = {});

/// The properties of a mesh that are chosen for an accuracy.
struct MeshSize {
  /// element size, m; for a .geo the factor on its own sizes
  double size;
  int order;                       ///< of the elements
  std::optional<double> edge_row;  ///< m
  /// Where elements are smaller; m. Empty: all are of one size.
  std::vector<mesh::SizeAt> places = {};
};

/// True if the element size can be chosen: for generators, .geo and .step.
bool has_size(const mesh::MeshOptions& mesh);
void set_size(mesh::MeshOptions& mesh, const MeshSize& size);
/// The element order in the options.
int order_of(const mesh::MeshOptions& mesh);
std::optional<double> edge_row_of(const mesh::MeshOptions& mesh);

/// The other orders that can be chosen.
std::vector<int> other_orders(const mesh::MeshOptions& mesh);
/// True if elements can be smaller at some places: of a .geo or .step.
bool takes_local_sizes(const mesh::MeshOptions& mesh);
/// True if the generator can make rows of this width along the edges.
bool takes_edge_row(const mesh::MeshOptions& mesh, double width);
/// The largest element size, m; for a .geo the factor on its own sizes.
double largest_size(const mesh::MeshOptions& mesh);
/// The size to begin with: a few elements per wavelength at omega [rad/s]; for a .geo its own size.
double first_size(const scene::Scene& scene, double omega);

/// The size rounded to two digits, so that ranks whose frequencies differ in the last bit choose
/// the same.
double rounded(double size);
/// A text such as "element_order = 3, element_size = 0.031 m".
std::string described(const MeshSize& size);

/// The least thickness of the shells, m; infinite if there are none.
double least_thickness(const scene::Scene& scene);

}  // namespace chladni::cases
