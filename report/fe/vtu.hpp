#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::report {

/// Values at the points or of the cells of a grid, one row for each; columns are components.
/// Six components are a symmetric tensor in the order of VTK: xx, yy, zz, xy, yz, xz.
struct VtuField {
  std::string name;
  Eigen::MatrixXd values;
};

/// Which cells of a grid belong to something: 1 for those that do, else 0.
struct VtuMarks {
  std::string name;
  std::vector<std::uint8_t> values;
};

/// An unstructured grid of VTK.
struct VtuGrid {
  Eigen::MatrixX3d points;        ///< m
  std::vector<int> connectivity;  ///< indices into `points`, cell by cell
  std::vector<int> offsets;       ///< of the end of each cell in `connectivity`
  std::vector<int> types;         ///< VTK's cell types
  std::vector<VtuField> of_points, of_cells;
  std::vector<VtuMarks> marks_of_cells;
};

/// VTK's number for a cell with the nodes of an element: linear cells at order 1, else Lagrange's.
int vtu_cell_type(mesh::Shape shape, int order);

/// VTK's number for a cell that is one node.
inline constexpr int vtu_vertex = 1;

/// The text of a .vtu file: VTK's XML with base64 arrays.
std::string vtu_text(const VtuGrid& grid);

}  // namespace chladni::report
