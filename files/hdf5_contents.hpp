#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "files/hdf5.hpp"

/// What a file holds, for whoever shows it as it is.
namespace chladni::files {

/// A dataset that a file holds itself.
struct Item {
  enum class Kind { reals, integers, texts };
  std::string name;
  Kind kind;
  std::size_t rank;  ///< number of extents
  std::string unit;  ///< its attribute; empty without one
};

/// All datasets but views of others, by their names.
/// @throws chladni::Error naming file and dataset for one that claims more than the file can hold.
std::vector<Item> contents(const Reader& reader);

}  // namespace chladni::files
