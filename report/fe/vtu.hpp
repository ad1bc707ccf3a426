#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

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

}  // namespace chladni::report
