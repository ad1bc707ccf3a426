#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/hdf5.hpp"

namespace chladni::files {

/// Owns one HDF5 identifier and closes it with the function for its kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle()
  {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// The type of text of at most `size` bytes in UTF-8, padded with zeros. Text of variable length is
/// in the global heap, where the library follows damaged lengths out of its buffers.
inline Handle text_type(std::size_t size)
{
  Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
  H5Tset_size(type.get(), size > 0 ? size : 1);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

/// Turns off HDF5's own error output; errors become exceptions here.
inline void silence_errors()
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Prepares the whole process for opening untrusted files: libhdf5 prints no messages and loads no
/// filter from HDF5_PLUGIN_PATH from now on.
inline void prepare_to_read()
{
  silence_errors();
  H5PLset_loading_state(0);
}

}  // namespace chladni::files

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

/// Parts of an HDF5 file that are not in it: values in other files, links to other files, and
/// values that need external code to be unpacked. None of them is followed, whoever sealed the
/// file.

namespace chladni::files {

/// The reason why the values of a dataset are not all in its file, or cannot be unpacked by libhdf5
/// alone: external storage, a virtual dataset of another file, or a filter other than deflate,
/// shuffle and fletcher32. Opens no other file.
/// @param creation  the creation properties of the dataset
/// @return a sentence without its subject; empty if all values are in the file
std::string foreign_part(hid_t creation);

/// True if a dataset stores nothing and shows values of others.
bool is_view(hid_t creation);

/// The first link of a file that leads out of it.
/// @return "NAME: WHY"; empty if there is none
std::string foreign_link(hid_t file);

/// A name from an untrusted file, without characters that control a terminal.
std::string shown(std::string name);

/// Calls `visitor(object, name, info, data)` for all objects of a file with their basic
/// information. It hides the different structures of the versions of HDF5 from 1.10 on.
inline void visit_objects(hid_t file, H5_iter_order_t order, H5O_iterate_t visitor, void* data)
{
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file, H5_INDEX_NAME, order, visitor, data, H5O_INFO_BASIC);
#else
  H5Ovisit2(file, H5_INDEX_NAME, order, visitor, data, H5O_INFO_BASIC);
#endif
}

}  // namespace chladni::files
