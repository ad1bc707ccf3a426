#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::mesh {

/// A DataArray of a .vtu.
struct VtuArray {
  std::string section;  ///< "Points", "Cells", "PointData", "CellData"
  std::string name;
  int line;
  std::int64_t components;
  bool is_real;
  std::vector<double> reals;           ///< where it is
  std::vector<std::int64_t> integers;  ///< where it is not

  std::size_t size() const { return is_real ? reals.size() : integers.size(); }
  [[noreturn]] void refuse(std::string_view why) const;
};

/// The one piece of an unstructured grid.
struct VtuPiece {
  std::int64_t n_points, n_cells;
  std::vector<VtuArray> arrays;
  int n_texts;  ///< arrays of texts at points or cells, which are left out
};

/// The piece of a .vtu, its arrays in text, in base64 or as appended bytes, packed by zlib or not.
/// @throws chladni::Error naming line and array of what is wrong or not known.
VtuPiece vtu_piece(const std::string& text);

}  // namespace chladni::mesh
