// Files that are made to deceive, each of them without a seal and with one:
// what is read stands in the file itself, and nothing is run.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/files/hdf5.hpp"
#include "common/files/seal.hpp"
#include "hostile_file.hpp"

namespace chladni::files {
namespace {

using test::all_seals, test::contains, test::dataset_properties, test::error_of,
    test::expect_refusal, test::make_file, test::make_x, test::ScratchFolder, test::Sealed;

TEST(HostileFile, HasNoValuesInOtherFiles)
{
  const ScratchFolder folder;
  std::ofstream(folder.file("secret")) << "secret!!";
  expect_refusal(folder, ": x: has its values in another file", [&](hid_t file) {
    const Handle creation = dataset_properties();
    H5Pset_external(creation.get(), folder.file("secret").c_str(), 0, H5F_UNLIMITED);
    make_x(file, 1, creation);
  });
}

TEST(HostileFile, ShowsNoValuesOfOtherFiles)
{
  const ScratchFolder folder;
  Writer writer(folder.file("other.h5"));
  writer.write("x", Eigen::VectorXd::Ones(3), "m");
  writer.commit();
  expect_refusal(folder, ": x: shows values of another file", [&](hid_t file) {
    const Handle creation = dataset_properties();
    const hsize_t n = 3;
    const Handle space{H5Screate_simple(1, &n, nullptr), H5Sclose};
    H5Pset_virtual(creation.get(), space.get(), folder.file("other.h5").c_str(), "x", space.get());
    make_x(file, n, creation);
  });
}

TEST(HostileFile, LinksToNoOtherFile)
{
  const ScratchFolder folder;
  Writer writer(folder.file("other.h5"));
  writer.write("x", Eigen::VectorXd::Ones(3), "m");
  writer.commit();
  expect_refusal(folder, ": x: links to another file", [&](hid_t file) {
    H5Lcreate_external(folder.file("other.h5").c_str(), "x", file, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
  expect_refusal(folder, ": group/deep: links to another file", [&](hid_t file) {
    const Handle group{H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
    H5Lcreate_external(folder.file("other.h5").c_str(), "x", group.get(), "deep", H5P_DEFAULT,
                       H5P_DEFAULT);
    H5Lcreate_soft("group/deep", file, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
}

std::size_t pass_through(unsigned /*flags*/, std::size_t /*n*/, const unsigned* /*values*/,
                         std::size_t n_bytes, std::size_t* /*size*/, void** /*buffer*/)
{
  return n_bytes;
}

constexpr H5Z_filter_t strange_filter = 32015;

/// "x" packed by a filter that is known while it is written only.
void pack_strangely(hid_t file)
{
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, strange_filter, 1,       1,
                            "strange",        nullptr,        nullptr, pass_through};
  H5Zregister(&filter);
  {
    const Handle creation = dataset_properties();
    const hsize_t n = 4;
    const std::array<double, 4> values{1.0, 2.0, 3.0, 4.0};
    H5Pset_chunk(creation.get(), 1, &n);
    H5Pset_filter(creation.get(), strange_filter, H5Z_FLAG_MANDATORY, 0, nullptr);
    const Handle x = make_x(file, n, creation);
    H5Dwrite(x.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Fflush(file, H5F_SCOPE_LOCAL);
  }
  H5Zunregister(strange_filter);
}

TEST(HostileFile, LoadsNoFilter)
{
  const ScratchFolder folder;
  H5PLprepend(HOSTILE_FILTER_FOLDER);
  setenv("CHLADNI_TEST_TRACE", folder.file("trace").c_str(), 1);
  expect_refusal(folder, ": x: is packed with filter 32015", pack_strangely);
  EXPECT_FALSE(std::filesystem::exists(folder.file("trace")));
}

TEST(HostileFile, MayBePackedWithTheFiltersOfEveryLibhdf5)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  for (const Sealed sealed : all_seals) {
    make_file(path, sealed, [](hid_t file) {
      const Handle creation = dataset_properties();
      const hsize_t n = 1000;
      H5Pset_chunk(creation.get(), 1, &n);
      H5Pset_shuffle(creation.get());
      H5Pset_deflate(creation.get(), 9);
      H5Pset_fletcher32(creation.get());
      const std::vector<double> ones(n, 1.0);
      const Handle x = make_x(file, n, creation);
      H5Dwrite(x.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, ones.data());
    });
    EXPECT_EQ(Reader(path).vector("x"), Eigen::VectorXd::Ones(1000));
  }
}

TEST(HostileFile, IsAnOrdinaryFile)
{
  const ScratchFolder folder;
  const std::string fifo = folder.file("fifo"), socket_name = folder.file("socket");
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  socket_name.copy(address.sun_path, sizeof address.sun_path - 1);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(descriptor);
  for (const auto& [path, what] : {std::pair{fifo, "a FIFO"},
                                   {socket_name, "a socket"},
                                   {std::string("/dev/zero"), "a device"},
                                   {folder.path().string(), "a folder"}}) {
    const std::string expected = fmt::format("{}: is {}, expected an ordinary file", path, what);
    EXPECT_EQ(error_of([&, path = path] { Reader reader(path); }), expected);
    EXPECT_EQ(error_of([&, path = path] { seal_file(path); }), expected);
  }
}

}  // namespace
}  // namespace chladni::files
