#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// A dataset of a universal file: the lines after its number.
struct UnvDataset {
  std::string number;  ///< "2412"; of a binary dataset "58b" with more after it
  int line;            ///< line of the number
  std::vector<std::string_view> lines;
};

/// Divides a universal file into datasets, which refer to `text`. Words between them are left out.
/// @throws chladni::Error naming a line at which a dataset should begin, or a dataset that does not
///         end.
std::vector<UnvDataset> unv_datasets(const std::string& text);

/// Reads nodes (dataset 2411), elements (2412) and groups (2435, 2452, 2467, 2477). Elements
/// without a group get the group of their physical property, `property_N`. Other datasets are left
/// out, results with a note.
/// @param length_unit  m per unit of the file; a note tells if its dataset 164 says otherwise
/// @throws chladni::Error naming line and dataset of what is wrong or unknown.
ExchangeMesh unv_mesh(const std::string& text, double length_unit);

}  // namespace chladni::mesh
