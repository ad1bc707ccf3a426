#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "files/hdf5_handle.hpp"

/// What a file claims of a dataset, checked before anything of it is read. The process that tries a
/// file first asks the same functions as Reader, so that it reads what Reader will, as Reader will.
namespace chladni::files {

/// The most memory that the values of a file of `file_size` bytes may take in all, bytes. Numbers
/// of a file of ours take what they take in the file, packed with deflate (level 9) 1.0 to 1.8
/// times as much; zeros alone reach 1030 times. What a small file claims harms nobody.
constexpr std::uint64_t most_memory(std::uint64_t file_size)
{
  return (std::uint64_t{128} << 20) + 16 * file_size;
}

/// How the values of a dataset stand in memory: as double, int64_t or text of fixed length.
/// @return nothing for all that Reader takes from no file
std::optional<Handle> memory_type(hid_t dataset);

/// The extents of a dataset that is no view, by what it was created with; none when the values
/// could not come from what the file stores of them. Compressed ones can be larger than that, by a
/// factor of 1030 at most.
std::optional<std::vector<Eigen::Index>> plausible_shape(hid_t dataset, hid_t creation,
                                                         hsize_t file_size);

/// An open dataset whose kind is checked and whose extents fit into its file.
struct Dataset {
  Handle id;
  std::vector<Eigen::Index> shape;
  Handle type;  ///< in memory

  std::size_t n_values() const;
  std::size_t n_bytes() const;  ///< of all values in memory
};

/// Reads `dataset.n_bytes()` bytes.
/// @return whether libhdf5 could
bool read_values(const Dataset& dataset, void* values);

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
  std::uint64_t& memory_left;  ///< that its values may still take, bytes
};

/// How messages call values of this kind.
const char* class_name(H5T_class_t type);

/// @throws chladni::Error, as Reader::fail, when it is missing, of another kind or shape, leads out
/// of the file, or claims more values than the file can hold or than fit into `memory_left`, from
/// which they are taken.
Dataset open_dataset(const Source& source, const std::string& name, const Expected& expected);

}  // namespace chladni::files
