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
  /// The values if `is_real`; else empty.
  std::vector<double> reals;
  /// The values if not `is_real`; else empty.
  std::vector<std::int64_t> integers;

  std::size_t size() const { return is_real ? reals.size() : integers.size(); }
  [[noreturn]] void refuse(std::string_view why) const;
};

/// The single piece of an unstructured grid.
struct VtuPiece {
  std::int64_t n_points, n_cells;
  std::vector<VtuArray> arrays;
  int n_texts;  ///< number of arrays of texts at points or cells, which are left out
};

/// Reads the piece of a .vtu. Its arrays may be text, base64 or appended bytes, compressed by zlib
/// or not.
/// @throws chladni::Error naming line and array of what is wrong or unknown.
VtuPiece vtu_piece(const std::string& text);

}  // namespace chladni::mesh
