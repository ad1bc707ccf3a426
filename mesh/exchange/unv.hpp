#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// A dataset of a universal file: the lines between its number and its end.
struct UnvDataset {
  std::string number;  ///< "2412"; of a binary one "58b" and more
  int line;            ///< of the number
  std::vector<std::string_view> lines;
};

/// The datasets of a universal file, which must outlive them.
/// @throws chladni::Error naming the line where none begins or one does not end.
std::vector<UnvDataset> unv_datasets(const std::string& text);

/// Nodes (dataset 2411), elements (2412) and groups (2435, 2452, 2467, 2477). Elements of no group
/// are of the group of their physical property, `property_N`. What says nothing of a mesh is left
/// out, results with a note.
/// @param length_unit  m, of 1 in the file; another one in its dataset 164 is told in a note
/// @throws chladni::Error naming line and dataset of what is wrong or not known.
ExchangeMesh unv_mesh(const std::string& text, double length_unit);

}  // namespace chladni::mesh
