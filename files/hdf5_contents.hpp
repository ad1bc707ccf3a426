#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "files/hdf5.hpp"

/// The contents of a file, for programs that show them unchanged.
namespace chladni::files {

/// A dataset that is stored in the file itself.
struct Item {
  enum class Kind { reals, integers, texts };
  std::string name;
  Kind kind;
  std::size_t rank;  ///< number of extents
  std::string unit;  ///< its attribute; empty if there is none
};

/// All datasets except views of others, by their names.
/// @throws chladni::Error naming file and dataset for one that claims more than the file can hold.
std::vector<Item> contents(const Reader& reader);

}  // namespace chladni::files
