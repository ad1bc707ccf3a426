#pragma once

#include <cstddef>
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

/// The encoding of the arrays of a file.
struct VtuEncoding {
  std::size_t header_bytes = 4;  ///< of each number in the header of an array
  bool is_compressed = false;
  bool is_base64 = true;
};

/// Decodes the bytes of an array.
/// @param encoded  the text of an array, or the appended bytes from its offset on
/// @throws chladni::Error with half a sentence when it is damaged or shorter than its header says.
std::string vtu_bytes(std::string_view encoded, const VtuEncoding& encoding);

/// Reads the values of an array, of the type "Float32", "Int64" or the like, from text.
/// @throws chladni::Error with half a sentence for another type and for a word that is no such
///         number.
void read_words(VtuArray& array, const std::string& type, std::string_view text);
/// Reads the values of an array from decoded bytes.
/// @throws chladni::Error with half a sentence for another type.
void read_bytes(VtuArray& array, const std::string& type, const std::string& bytes);

}  // namespace chladni::mesh
