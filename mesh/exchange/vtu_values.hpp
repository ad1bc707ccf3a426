#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mesh/exchange/vtu_arrays.hpp"

namespace chladni::mesh {

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
