#pragma once

#include <hdf5.h>

#include <cstddef>
#include <utility>

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
