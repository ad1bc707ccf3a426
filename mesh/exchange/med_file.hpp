#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/hdf5_handle.hpp"

namespace chladni::mesh {

/// The HDF5 groups, attributes and datasets of a MED file, by their path from the root. All
/// functions throw chladni::Error that names the object.
class MedFile {
 public:
  /// @param bytes  contents of the file, read from memory: libhdf5 opens and locks nothing
  /// @throws chladni::Error when it is no HDF5, or a link leads out of the file.
  explicit MedFile(const std::string& bytes);

  bool has(const std::string& name) const;
  /// The names of the members of a group in alphabetical order; empty if there is no such group.
  std::vector<std::string> members(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name, const std::string& attribute) const;

  std::vector<std::int64_t> integers(const std::string& name) const;
  std::vector<double> reals(const std::string& name) const;
  /// Texts of `length` characters each, without trailing blanks and zeros.
  std::vector<std::string> texts(const std::string& name, std::size_t length) const;

 private:
  files::Handle file_;
};

}  // namespace chladni::mesh
