#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mesh/exchange/vtu_arrays.hpp"

namespace chladni::mesh {

/// How the arrays of a file are written.
struct VtuEncoding {
  std::size_t header_bytes = 4;  ///< of each number in front of an array
  bool is_compressed = false;
  bool is_base64 = true;
};

/// The bytes of an array.
/// @param encoded  the text of an array, or the appended bytes from its offset on
/// @throws chladni::Error, a half sentence, where it is damaged or ends before its header says.
std::string vtu_bytes(std::string_view encoded, const VtuEncoding& encoding);

/// Puts values into an array, of the type "Float32", "Int64" or the like.
/// @throws chladni::Error, a half sentence, for another type and for what is no number of it.
void read_words(VtuArray& array, const std::string& type, std::string_view text);
void read_bytes(VtuArray& array, const std::string& type, const std::string& bytes);

}  // namespace chladni::mesh
