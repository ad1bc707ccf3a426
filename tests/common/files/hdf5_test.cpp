#include "common/files/hdf5.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "scratch_folder.hpp"

namespace chladni::files {
namespace {

using test::ScratchFolder, test::bytes_of, test::error_of;

std::size_t n_files_in(const ScratchFolder& folder)
{
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

TEST(Hdf5, ReturnsWhatWasWrittenBitByBit)
{
  const ScratchFolder folder;
  const Eigen::MatrixXd A{{1.0 / 3.0, -0.0, 5e-324}, {1e308, -1e-300, 2.0}};
  const Eigen::VectorXd v{{0.1, 0.2}};
  const IntegerMatrix indices{{1, 2}, {-3, std::int64_t{1} << 60}};
  Writer writer(folder.file("a.h5"));
  writer.attribute("/", "format", "test");
  writer.attribute("/", "version", 3);
  writer.write("deep/in/groups/A", A, "m");
  writer.write("v", v, "rad/s");
  writer.write("x", 0.1, "1");
  writer.write("empty", Eigen::MatrixXd(0, 3), "m");
  writer.write("indices", indices, "1");
  writer.write("numbers", std::span<const int>(std::vector<int>{3, 1}), "1");
  writer.write("text", "Grüße,\nzwei Zeilen");
  writer.write("texts", std::vector<std::string>{"", "b"});
  writer.commit();
  const Reader reader(folder.file("a.h5"));
  reader.expect_format("test", 3);
  EXPECT_EQ(reader.matrix("deep/in/groups/A", {2, 3}), A);
  EXPECT_TRUE(std::signbit(reader.matrix("deep/in/groups/A")(0, 1)));
  EXPECT_EQ(reader.vector("v"), v);
  EXPECT_EQ(reader.real("x"), 0.1);
  EXPECT_EQ(reader.matrix("empty").cols(), 3);
  EXPECT_EQ(reader.integer_matrix("indices"), indices);
  EXPECT_EQ(reader.integers("numbers"), (std::vector<std::int64_t>{3, 1}));
  EXPECT_EQ(reader.text("text"), "Grüße,\nzwei Zeilen");
  EXPECT_EQ(reader.texts("texts"), (std::vector<std::string>{"", "b"}));
  EXPECT_EQ(reader.text_attribute("deep/in/groups/A", "unit"), "m");
  EXPECT_TRUE(reader.contains("deep/in"));
  EXPECT_FALSE(reader.contains("deep/out/groups"));
}

TEST(Hdf5Reader, TellsWhatAFileHoldsWithoutItsViews)
{
  const ScratchFolder folder;
  Writer writer(folder.file("a.h5"));
  writer.write("deep/A", Eigen::MatrixXd::Ones(3, 2), "m");
  writer.write("n", std::int64_t{7}, "1");
  writer.write("texts", std::vector<std::string>{"a", "b"});
  writer.view_column("shown", {.matrix = "deep/A", .rows = 3, .cols = 2, .column = 1});
  writer.commit();
  const Reader reader(folder.file("a.h5"));
  std::vector<std::string> found;
  for (const Item& item : contents(reader))
    found.push_back(fmt::format("{} {} {}", item.name, item.rank, item.unit));
  EXPECT_EQ(found, (std::vector<std::string>{"deep/A 2 m", "n 0 1", "texts 1 text"}));
}

TEST(Hdf5Writer, LeavesTheOldFileWhenInterrupted)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  {
    Writer writer(path);
    writer.write("x", 1.0, "m");
    writer.commit();
  }
  const std::string before = bytes_of(path);
  {
    Writer writer(path);
    writer.write("x", 2.0, "m");
    EXPECT_EQ(n_files_in(folder), 3u);
    EXPECT_EQ(bytes_of(path), before);
  }
  EXPECT_EQ(bytes_of(path), before);
  EXPECT_EQ(n_files_in(folder), 1u);
}

TEST(Hdf5Writer, RefusesAFolderThatDoesNotExistAndATakenName)
{
  const ScratchFolder folder;
  EXPECT_NE(error_of([&] { Writer(folder.file("none/a.h5")); }).find("none/a.h5"),
            std::string::npos);
  Writer writer(folder.file("a.h5"));
  writer.write("x", 1.0, "m");
  EXPECT_NE(error_of([&] { writer.write("x", 1.0, "m"); }).find("x"), std::string::npos);
}

TEST(Hdf5Reader, NamesFileDatasetAndWhatWasExpected)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  Writer writer(path);
  writer.write("A", Eigen::MatrixXd::Ones(2, 3), "m");
  writer.write("bad", std::numeric_limits<double>::quiet_NaN(), "m");
  writer.write("text", "a");
  writer.group("group");
  writer.commit();
  const Reader reader(path);
  EXPECT_EQ(error_of([&] { reader.matrix("B"); }), path + ": B: is missing");
  EXPECT_EQ(error_of([&] {
              reader.matrix("A", {3, any});
            }),
            path + ": A: has shape [2 x 3], expected [3 x any]");
  EXPECT_EQ(error_of([&] { reader.vector("A"); }), path + ": A: has shape [2 x 3], expected [any]");
  EXPECT_EQ(error_of([&] { reader.integers("A"); }),
            path + ": A: holds floating-point numbers, expected integers");
  EXPECT_EQ(error_of([&] { reader.real("bad"); }),
            path + ": bad: value 1 of 1 is nan, expected finite numbers");
  EXPECT_EQ(error_of([&] { reader.text("A"); }),
            path + ": A: holds floating-point numbers, expected text");
  EXPECT_EQ(error_of([&] { reader.matrix("group"); }), path + ": group: is not a readable dataset");
  EXPECT_EQ(error_of([&] { reader.expect_format("x", 1); }),
            path + ": /: has no attribute 'format'");
}

TEST(Hdf5Reader, RefusesFilesThatAreNoneOrCutShort)
{
  const ScratchFolder folder;
  EXPECT_NE(error_of([&] { Reader(folder.file("absent.h5")); }).find("no such file"),
            std::string::npos);
  const std::string path = folder.file("a.h5");
  Writer writer(path);
  writer.write("A", Eigen::MatrixXd::Ones(100, 100), "m");
  writer.commit();
  for (const auto size : {std::filesystem::file_size(path) - 1, std::uintmax_t{3000},
                          std::uintmax_t{100}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(path, size);
    EXPECT_NE(error_of([&] { Reader(path).matrix("A"); }).find(path), std::string::npos) << size;
  }
}

}  // namespace
}  // namespace chladni::files
