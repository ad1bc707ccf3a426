#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "files/hdf5_handle.hpp"

/// Checks of a file's claims about a dataset before anything of it is read. The process that tries
/// a file first uses the same functions as Reader, so that both read the same in the same way.
namespace chladni::files {

/// The largest total memory, bytes, for the values of a file of `file_size` bytes. Numbers in our
/// files take 1.0 to 1.8 times their size in the file when packed with deflate (level 9); zeros
/// alone reach 1030 times. Small files may claim more, since they can do no harm.
constexpr std::uint64_t most_memory(std::uint64_t file_size)
{
  return (std::uint64_t{128} << 20) + 16 * file_size;
}

/// The type of a dataset's values in memory: double, int64_t or text of fixed length.
/// @return absent for a type that Reader accepts from no file
std::optional<Handle> memory_type(hid_t dataset);

/// The extents of a dataset that is no view, by its creation properties; absent if its values
/// cannot come from what the file stores of them. Compressed values can be larger by a factor of
/// 1030 at most.
std::optional<std::vector<Eigen::Index>> plausible_shape(hid_t dataset, hid_t creation,
                                                         hsize_t file_size);

/// An open dataset whose kind has been checked and whose extents fit into its file.
struct Dataset {
  Handle id;
  std::vector<Eigen::Index> shape;
  Handle type;  ///< in memory

  std::size_t n_values() const;
  std::size_t n_bytes() const;  ///< of all values in memory
};

/// Reads `dataset.n_bytes()` bytes.
/// @return false if libhdf5 failed
bool read_values(const Dataset& dataset, void* values);

/// The expected kind and extents of a dataset.
struct Expected {
  H5T_class_t type;
  std::vector<Eigen::Index> shape;  ///< `any` leaves an extent open
};

/// A file as its reader has opened it.
struct Source {
  const Reader& reader;
  hid_t file;
  hsize_t size;
  std::uint64_t& memory_left;  ///< bytes that further values may take
};

/// The name of this kind of values in messages.
const char* class_name(H5T_class_t type);

/// Opens a dataset and checks it. The memory for its values is subtracted from `memory_left`.
/// @throws chladni::Error, as Reader::fail, when it is missing, of another kind or shape, leads out
///         of the file, or claims more values than the file can hold or than fit into
///         `memory_left`.
Dataset open_dataset(const Source& source, const std::string& name, const Expected& expected);

}  // namespace chladni::files
