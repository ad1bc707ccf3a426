#include "hostile_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/files/hdf5.hpp"
#include "common/files/seal.hpp"

namespace chladni::files::test {
bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

void make_file(const std::string& path, Sealed sealed, const std::function<void(hid_t file)>& fill)
{
  std::filesystem::remove(path);
  {
    const Handle creation{H5Pcreate(H5P_FILE_CREATE), H5Pclose};
    H5Pset_userblock(creation.get(), sealed == Sealed::inside ? seal_size : 0);
    const Handle file{H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT),
                      H5Fclose};
    fill(file.get());
  }
  if (sealed == Sealed::inside) write_seal(path);
}

Handle dataset_properties()
{
  return {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
}

Handle make_x(hid_t file, hsize_t n, const Handle& creation)
{
  const Handle space{H5Screate_simple(1, &n, nullptr), H5Sclose};
  return {H5Dcreate2(file, "x", H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT, creation.get(),
                     H5P_DEFAULT),
          H5Dclose};
}

void expect_refusal(const ScratchFolder& folder, const std::string& part,
                    const std::function<void(hid_t file)>& fill)
{
  const std::string path = folder.file("a.h5");
  for (const Sealed sealed : all_seals) {
    SCOPED_TRACE(int(sealed));
    make_file(path, sealed, fill);
    const std::string error = error_of([&] { Reader(path).vector("x"); });
    EXPECT_TRUE(contains(error, path) && contains(error, part)) << error;
    const std::string unsealable = error_of([&] { seal_file(path); });
    EXPECT_TRUE(contains(unsealable, "cannot be sealed")) << unsealable;
  }
}

}  // namespace chladni::files::test
