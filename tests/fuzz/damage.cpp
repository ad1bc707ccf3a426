#include "damage.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/files/hdf5_objects.hpp"

namespace chladni::fuzz {
namespace {

using files::Handle;

herr_t add_name(hid_t, const char* name, const H5O_info_t* info, void* names)
{
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> dataset_names(hid_t file)
{
  std::vector<std::string> names;
  files::visit_objects(file, H5_ITER_INC, add_name, &names);
  return names;
}

constexpr std::array<hsize_t, 16> extents{
    0,  1,        2,        3,          5,          6,          9,          12,
    18, 1U << 16, 1U << 20, 1ULL << 31, 1ULL << 32, 1ULL << 40, 1ULL << 61, (1ULL << 63) - 1};

Handle strange_type(unsigned how)
{
  switch (how % 6) {
    case 0:
      return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    case 1:
      return {H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
    case 2:
      return {H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose};
    case 3:
      return {H5Tcopy(H5T_NATIVE_UINT8), H5Tclose};
    case 4:
      return files::text_type(how);
    default: {
      Handle type = files::text_type(1);
      H5Tset_size(type.get(), H5T_VARIABLE);
      return type;
    }
  }
}

/// Without values, so that it costs nothing.
void make_anew(hid_t file, const std::string& name, unsigned what, unsigned how)
{
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const int rank = int(what % 4);
  const std::array<hsize_t, 3> shape{extents[how % 16], extents[(how / 16) % 16],
                                     extents[(how + what) % 16]};
  const Handle space{
      rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape.data(), nullptr), H5Sclose};
  const Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_LATE);
  if (what % 3 == 0 && rank > 0) {
    const std::array<hsize_t, 3> chunk{1, 1, 1};
    H5Pset_chunk(creation.get(), rank, chunk.data());
  }
  const Handle type = strange_type(what / 4);
  const Handle made{H5Dcreate2(file, name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                               creation.get(), H5P_DEFAULT),
                    H5Dclose};
}

/// As many values as before, a few of them strange.
void change_values(hid_t file, const std::string& name, unsigned how)
{
  const Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid() || H5Dget_storage_size(dataset.get()) == 0) return;  // made anew
  const Handle type{H5Dget_type(dataset.get()), H5Tclose};
  const Handle space{H5Dget_space(dataset.get()), H5Sclose};
  const hssize_t n = H5Sget_simple_extent_npoints(space.get());
  if (n <= 0 || n > 4096) return;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::array reals{std::nan(""), infinite, -infinite, -1.0, 1e308, 0.0, 1e-320, -0.0};
  constexpr std::array<std::int64_t, 8> integers{-1,
                                                 1,
                                                 7,
                                                 1000,
                                                 1LL << 31,
                                                 1LL << 40,
                                                 std::numeric_limits<std::int64_t>::max(),
                                                 std::numeric_limits<std::int64_t>::min()};
  const auto at = std::size_t(how / 8) % std::size_t(n);
  if (H5Tget_class(type.get()) == H5T_FLOAT) {
    std::vector<double> values(static_cast<std::size_t>(n));
    H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values[at] = reals[how % 8];
    H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  } else if (H5Tget_class(type.get()) == H5T_INTEGER) {
    std::vector<std::int64_t> values(static_cast<std::size_t>(n));
    H5Dread(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values[at] = integers[how % 8];
    H5Dwrite(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  } else if (H5Tget_class(type.get()) == H5T_STRING && H5Tis_variable_str(type.get()) == 0) {
    std::vector<char> values(static_cast<std::size_t>(n) * H5Tget_size(type.get()));
    H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values[std::size_t(how) % values.size()] = "/.\0a\n\xff z"[how % 8];
    H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
}

std::vector<hsize_t> extents_of(hid_t file, const std::string& name)
{
  const Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) return {};
  const Handle space{H5Dget_space(dataset.get()), H5Sclose};
  std::vector<hsize_t> shape(std::size_t(std::max(H5Sget_simple_extent_ndims(space.get()), 0)));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return shape;
}

/// Of the same type, all zeros.
void make_of_shape(hid_t file, const std::string& name, const std::vector<hsize_t>& shape)
{
  const Handle type = [&] {
    const Handle old{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
    return Handle{H5Dget_type(old.get()), H5Tclose};
  }();
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const Handle space{H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose};
  const Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  const Handle made{H5Dcreate2(file, name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                               creation.get(), H5P_DEFAULT),
                    H5Dclose};
}

/// Everything of a group that is as long as one dataset of it becomes shorter with it, so that
/// all still fits together.
void cut_together(hid_t file, const std::string& name, unsigned how)
{
  const std::vector<hsize_t> chosen = extents_of(file, name);
  if (chosen.empty() || chosen[0] > 4096) return;
  const hsize_t n = chosen[how % chosen.size()];
  const std::string group = name.substr(0, name.find('/') + 1);
  for (const std::string& other : dataset_names(file)) {
    std::vector<hsize_t> shape = extents_of(file, other);
    if (!other.starts_with(group) || std::ranges::find(shape, n) == shape.end()) continue;
    std::ranges::replace(shape, n, hsize_t{how / 4 % 3});
    make_of_shape(file, other, shape);
  }
}

void change_version(hid_t file, unsigned how)
{
  H5Adelete(file, "version");
  if (how % 3 == 0) return;
  const Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const Handle attribute{
      H5Acreate2(file, "version", how % 3 == 1 ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, space.get(),
                 H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose};
  const std::int64_t version = how;
  H5Awrite(attribute.get(), H5T_NATIVE_INT64, &version);
}

}  // namespace

void damage(const std::string& path, std::span<const std::uint8_t> bytes)
{
  files::silence_errors();
  const Handle file{H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  if (!file.valid()) return;
  const std::vector<std::string> names = dataset_names(file.get());
  for (std::size_t i = 0; i + 3 <= bytes.size() && i < 48; i += 3) {
    const std::string& name = names[bytes[i] % names.size()];
    const unsigned what = bytes[i + 1], how = bytes[i + 2];
    if (what < 20) H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT);
    if (what >= 20 && what < 90) make_anew(file.get(), name, what, how);
    if (what >= 90 && what < 200) change_values(file.get(), name, how);
    if (what >= 200 && what < 210) change_version(file.get(), how);
    if (what >= 210 && what < 230) cut_together(file.get(), name, how);
    if (what < 230) continue;
    H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT);
    H5Lcreate_hard(file.get(), names[how % names.size()].c_str(), file.get(), name.c_str(),
                   H5P_DEFAULT, H5P_DEFAULT);
  }
}

}  // namespace chladni::fuzz
