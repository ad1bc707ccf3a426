#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/shell_resultants.hpp"
#include "plate/plate_options.hpp"
#include "report/fe/vtu.hpp"

namespace chladni::report {

/// The mesh as a VTK grid. Groups of elements that meet do not share points, so that thickness and
/// section forces may be discontinuous.
struct SceneGrid {
  VtuGrid grid;  ///< with the thickness at the points, and number, group and rank of the cells
  std::vector<int> node_of_point, group_of_point;
};

/// The grid of a mesh.
/// @param owners  [n_nodes] rank of each node
SceneGrid scene_grid(const mesh::Mesh& mesh, std::span<const plate::ShellSection> sections,
                     std::span<const int> owners);

/// Adds displacement and rotation of the points, with `prefix` before their names.
/// @param motions  [n_nodes x 6], from plate::node_motions
void add_motions(SceneGrid& scene_grid, const Eigen::MatrixXd& motions, const std::string& prefix);

/// Adds membrane forces, moments and shear forces at the points.
/// @param resultants  for each section, from plate::nodal_resultants
void add_resultants(SceneGrid& scene_grid, const mesh::Mesh& mesh,
                    std::span<const plate::ShellSection> sections,
                    std::span<const plate::ShellResultants> resultants);

}  // namespace chladni::report
