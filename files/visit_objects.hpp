#pragma once

#include <hdf5.h>

namespace chladni::files {

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
