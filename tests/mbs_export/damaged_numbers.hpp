#pragma once

#include <hdf5.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/files/hdf5_objects.hpp"
#include "common/files/seal.hpp"

namespace chladni::mbs_export::test {

/// Names of all datasets of real numbers in a file.
inline std::vector<std::string> real_datasets(const std::string& path)
{
  std::vector<std::string> names;
  const auto add = [](hid_t file, const char* name, const H5O_info_t* object, void* list) {
    if (object->type != H5O_TYPE_DATASET) return 0;
    const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(dataset),
                space = H5Dget_space(dataset);
    if (H5Tget_class(type) == H5T_FLOAT && H5Sget_simple_extent_npoints(space) > 0)
      static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(dataset);
    return 0;
  };
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  files::visit_objects(file, H5_ITER_NATIVE, add, &names);
  H5Fclose(file);
  return names;
}

/// Replaces the last number of a dataset, and seals the file again.
/// @return the number that was there
inline double replace_last(const std::string& path, const std::string& name, double by)
{
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  const double before = values.back();
  values.back() = by;
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  files::seal_file(path);
  return before;
}

}  // namespace chladni::mbs_export::test
