#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "files/hdf5_handle.hpp"

/// What a file claims of a dataset, checked before anything of it is read.
namespace chladni::files {

/// An open dataset whose kind is checked and whose extents fit into its file.
struct Dataset {
  Handle id;
  std::vector<Eigen::Index> shape;

  std::size_t n_values() const
  {
    std::size_t n = 1;
    for (const Eigen::Index extent : shape) n *= static_cast<std::size_t>(extent);
    return n;
  }
};

/// What to expect of a dataset.
struct Expected {
  H5T_class_t type;
  std::vector<Eigen::Index> shape;  ///< `any` leaves an extent open
};

/// A file as its reader has it open.
struct Source {
  const Reader& reader;
  hid_t file;
  hsize_t size;
};

/// How messages call values of this kind.
const char* class_name(H5T_class_t type);

/// @throws chladni::Error, as Reader::fail, when it is missing, of another kind or shape, or claims
/// more values than the file can hold.
Dataset open_dataset(const Source& source, const std::string& name, const Expected& expected);

}  // namespace chladni::files
