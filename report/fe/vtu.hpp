#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/shell_resultants.hpp"
#include "plate/plate_options.hpp"
#include "report/fe/mesh_report.hpp"
#include "sound/tone.hpp"

namespace chladni::report {

/// Values at the points or cells of a grid, one row each; columns are components. Six components
/// are a symmetric tensor in VTK's order xx, yy, zz, xy, yz, xz.
struct VtuField {
  std::string name;
  Eigen::MatrixXd values;
};

/// Membership of the cells of a grid in a set: 1 for members, else 0.
struct VtuMarks {
  std::string name;
  std::vector<std::uint8_t> values;
};

/// An unstructured grid as VTK defines it.
struct VtuGrid {
  Eigen::MatrixX3d points;        ///< m
  std::vector<int> connectivity;  ///< indices into `points`, cell by cell
  std::vector<int> offsets;       ///< end of each cell in `connectivity`
  std::vector<int> types;         ///< VTK's cell types
  std::vector<VtuField> of_points, of_cells;
  std::vector<VtuMarks> marks_of_cells;
};

/// VTK's cell type for an element: the linear cell at order 1, else the Lagrange cell.
int vtu_cell_type(mesh::Shape shape, int order);

/// VTK's cell type for a single node.
inline constexpr int vtu_vertex = 1;

/// The grid as the text of a .vtu file: VTK's XML with base64 arrays.
std::string vtu_text(const VtuGrid& grid);

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

/// Adds the stresses of solids and von Mises' at the points; nothing without solids.
/// @param stresses  for each section, from plate::nodal_stresses
void add_stresses(SceneGrid& scene_grid, const mesh::Mesh& mesh,
                  std::span<const plate::SolidSection> sections,
                  std::span<const Eigen::MatrixXd> stresses);

/// The mesh with its groups as the text of a .vtu file. Its cells are the elements, then the edges
/// of curve groups and the nodes of point groups. Cell arrays are the element number (0 for an edge
/// or a node), the index of the group in the mesh (-1 for none), and "group NAME", which is 1 for
/// the cells of that group. The "group NAME" arrays are left out when they would take more than 30
/// MB.
/// @param parts  of the groups of the mesh, from group_parts
std::string mesh_vtu(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts);

/// The sound field of the first tone around the body as the text of a .vtu file: real part,
/// imaginary part, amplitude and level of the pressure.
std::string sound_vtu(const std::vector<sound::Tone>& tones);

}  // namespace chladni::report
