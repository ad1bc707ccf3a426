#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/hdf5_handle.hpp"

namespace chladni::mesh {

/// What a MED file holds, as groups, attributes and datasets of HDF5. Names are paths from the
/// root. Functions throw chladni::Error that names the object.
class MedFile {
 public:
  /// @param bytes  of the file, out of which libhdf5 reads: it opens and locks nothing
  /// @throws chladni::Error for what is no HDF5, and where a link leads out of the file.
  explicit MedFile(const std::string& bytes);

  bool has(const std::string& name) const;
  /// Names of the members of a group, in alphabetical order; none where there is no such group.
  std::vector<std::string> members(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name, const std::string& attribute) const;

  std::vector<std::int64_t> integers(const std::string& name) const;
  std::vector<double> reals(const std::string& name) const;
  /// Texts of `length` characters each, without the blanks and zeros behind them.
  std::vector<std::string> texts(const std::string& name, std::size_t length) const;

 private:
  files::Handle file_;
};

}  // namespace chladni::mesh
