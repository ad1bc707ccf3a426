#include "mbs_export/measured/measured_functions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>

#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export {
namespace {

using files::test::error_of, files::test::ScratchFolder;
using Complex = std::complex<double>;

/// Units, and two nodes, in mm; forces in mN.
const std::string geometry = R"(    -1
   164
         1SI: mm              2
  1.0000000000000000D+03  1.0000000000000000D+03  1.0000000000000000D+00
  2.7314999999999998D+02
    -1
    -1
    15
         7         0         0         1  0.00000E+00  1.00000E+01  0.00000E+00
         9         0         0         1  2.50000E+02  0.00000E+00 -1.00000E+00
    -1
)";

/// What stands before the values of a function, from node 9 (load) to node 7 (output), each against
/// the axis of z; `form` is record 7.
std::string head(const std::string& form, const std::string& number = "    58", int type = 4)
{
  return "    -1\n" + number + "\nH1, 7 / 9\nNONE\n25-Nov-26\nNONE\nNONE\n" +
         fmt::format("{:5d}{:10d}{:5d}{:10d} {:<10}{:10d}{:4d} {:<10}{:10d}{:4d}\n", type, 1, 1, 0,
                     "NONE", 7, -3, "NONE", 9, 3) +
         form + "\n        18    0    0    0 Frequency            Hz                  \n" +
         "        12    1    0    0 Acceleration         mm/s^2              \n" +
         "        13    0    1    0 Force                mN                  \n" +
         "         0    0    0    0 NONE                 NONE                \n";
}

const std::string even_double =
    "         6         3         1  1.00000E+01  2.50000E+00  0.00000E+00";

/// (1 + 2i), (3 + 4i), (5 + 6i) at 10, 12.5 and 15 Hz in 4E20.12.
const std::string in_double =
    head(even_double) +
    R"(  1.000000000000E+00  2.000000000000E+00  3.000000000000E+00  4.000000000000E+00
  5.000000000000E+00  6.000000000000E+00
    -1
)";

class MeasuredFunctionsFile : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  std::string path_ = folder_.file("hammer.uff");

  MeasuredFunctions read(const std::string& text, std::optional<double> metres = {})
  {
    std::ofstream(path_, std::ios::binary) << text;
    return read_measured_functions(path_, metres);
  }
  std::string refused(const std::string& text)
  {
    return error_of([&] { read(text); });
  }
  /// Expects the values of `in_double` without units and in SI.
  void expect_one_to_six(const std::string& text)
  {
    const MeasuredFunctions measured = read(text, 1.0);
    ASSERT_EQ(measured.functions.size(), 1U);
    EXPECT_EQ(measured.f_Hz, Eigen::Vector3d(10.0, 12.5, 15.0));
    // The output's direction is against the axis.
    const Eigen::Vector3cd H(Complex(-1, -2), Complex(-3, -4), Complex(-5, -6));
    EXPECT_EQ(measured.functions[0].H, H);
  }
};

/// The text with one thing changed.
std::string with(std::string text, const std::string& from, const std::string& to)
{
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(MeasuredFunctionsFile, HasUnitsDirectionsAndNodes)
{
  const MeasuredFunctions measured = read(geometry + in_double);
  ASSERT_EQ(measured.functions.size(), 1U);
  const MeasuredFunction& one = measured.functions[0];
  EXPECT_EQ(one.name, "H1, 7 / 9");
  EXPECT_EQ(one.line, 13U);
  EXPECT_EQ(one.output.node, 7);
  EXPECT_EQ(one.output.component, 2);
  EXPECT_EQ(one.load.node, 9);
  EXPECT_EQ(one.quantity, ResponseQuantity::accelerance);
  // mm per mN are m per N; the output is against the axis.
  EXPECT_NEAR(std::abs(one.H[1] - Complex(-3.0, -4.0)), 0.0, 1e-14);
  EXPECT_NEAR(measured.nodes.at(9).position[0], 0.25, 1e-15);
  EXPECT_TRUE(measured.notes.empty());
  const MeasuredFunctions newtons =
      read(with(geometry, "  1.0000000000000000D+03  1.0000000000000000D+03",
                "  1.0000000000000000D+03  1.0000000000000000D+00") +
           in_double);
  EXPECT_NEAR(std::abs(newtons.functions[0].H[1] - Complex(-3.0, -4.0) * 1e-3), 0.0, 1e-17);
}

TEST_F(MeasuredFunctionsFile, HasRotationsForMomentsInSi)
{
  const MeasuredFunctions turned =
      read(geometry + with(with(in_double, "7  -3", "7   5"), "9   3", "9   4"));
  EXPECT_EQ(turned.functions[0].load.component, 3);
  // For each mN mm.
  EXPECT_NEAR(std::abs(turned.functions[0].H[1] - Complex(3.0, 4.0) * 1e6), 0.0, 1e-8);
}

TEST_F(MeasuredFunctionsFile, KnowsNodesWithAxesOfASensor)
{
  const std::string nodes = with(geometry, "9         0         0", "9         0         1");
  EXPECT_TRUE(read("    -1\n  2420\n         1\n    -1\n" + nodes + in_double)
                  .nodes.at(9)
                  .is_in_global_axes);
  const MeasuredFunctions measured =
      read("    -1\n    18\n         1\n    -1\n" + nodes + in_double);
  EXPECT_FALSE(measured.nodes.at(9).is_in_global_axes);
  EXPECT_TRUE(measured.nodes.at(7).is_in_global_axes);
}

TEST_F(MeasuredFunctionsFile, HasTheSameValuesInAllForms)
{
  expect_one_to_six(in_double);
  expect_one_to_six(
      head("         5         3         1  1.00000E+01  2.50000E+00  0.00000E+00") +
      "  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00  5.00000E+00  6.00000E+00\n    -1\n");
  expect_one_to_six(
      head("         5         3         0  0.00000E+00  0.00000E+00  0.00000E+00") +
      "  1.00000E+01  1.00000E+00  2.00000E+00  1.25000E+01  3.00000E+00  4.00000E+00\n"
      "  1.50000E+01  5.00000E+00  6.00000E+00\n    -1\n");
  expect_one_to_six(head("         6         3         0  0.00000E+00  0.00000E+00  0.00000E+00") +
                    "  1.00000E+01  1.000000000000E+00  2.000000000000E+00\n"
                    "  1.25000E+01  3.000000000000E+00  4.000000000000E+00\n"
                    "  1.50000E+01  5.000000000000E+00  6.000000000000E+00\n    -1\n");
  // No blanks between the numbers, and lines that end with a carriage return.
  expect_one_to_six(
      with(head("         5         3         1  1.00000E+01  2.50000E+00  0.00000E+00"), "NONE\n",
           "NONE\r\n") +
      "1.0000000E+002.0000000E+003.0000000E+004.0000000E+005.0000000E+006.0000000E+00\r\n"
      "    -1\r\n");
}

TEST_F(MeasuredFunctionsFile, HasRealValuesWithoutAnImaginaryPart)
{
  const MeasuredFunctions measured =
      read(head("         4         3         0  0.00000E+00  0.00000E+00  0.00000E+00") +
               "  1.00000E+01  1.000000000000E+00  1.25000E+01  3.000000000000E+00\n"
               "  1.50000E+01  5.000000000000E+00\n    -1\n",
           1.0);
  EXPECT_EQ(measured.functions[0].H[2], Complex(-5.0, 0.0));
}

/// The numbers as bytes of either order.
template <class Real>
std::string bytes_of_numbers(const std::vector<Real>& numbers, bool is_little_endian)
{
  std::string all;
  for (const Real number : numbers) {
    std::string bytes(sizeof(Real), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Real));
    if (is_little_endian != (std::endian::native == std::endian::little))
      std::ranges::reverse(bytes);
    all += bytes;
  }
  return all;
}

std::string binary_head(int order, std::size_t n_bytes)
{
  return fmt::format("    58b{:6d}{:6d}{:12d}{:12d}{:6d}{:6d}{:12d}{:12d}", order, 2, 11, n_bytes,
                     0, 0, 0, 0);
}

TEST_F(MeasuredFunctionsFile, IsReadInBytesOfEitherOrder)
{
  const std::vector<double> numbers{1, 2, 3, 4, 5, 6};
  const std::vector<float> halves{10, 1, 2, 12.5, 3, 4, 15, 5, 6};
  for (const int order : {1, 2}) {
    SCOPED_TRACE(order);
    expect_one_to_six(head(even_double, binary_head(order, 48)) +
                      bytes_of_numbers(numbers, order == 1) + "    -1\n");
    expect_one_to_six(head("         5         3         0  0.00000E+00  0.00000E+00  0.00000E+00",
                           binary_head(order, 36)) +
                      bytes_of_numbers(halves, order == 1) + "\n    -1\n");
    // A number of bytes that is half of the truth, and a line of -1 among them.
    std::vector<double> disguised = numbers;
    std::string delimiter = "\n    -1\n";
    if (order == 2) std::ranges::reverse(delimiter);
    std::memcpy(&disguised[1], delimiter.data(), 8);
    EXPECT_EQ(read(head(even_double, binary_head(order, 24)) +
                       bytes_of_numbers(disguised, order == 1) + "    -1\n",
                   1.0)
                  .functions[0]
                  .H[2],
              Complex(-5.0, -6.0));
  }
}

TEST_F(MeasuredFunctionsFile, LeavesOutOtherFunctionsAndDatasetsWithANote)
{
  const std::string coherence =
      with(head(even_double, "    58", 6), "         6         3", "         x         3");
  const std::string unknown = "    -1\n  3000\n anything\n    -1\n";
  const std::string zero_direction = with(in_double, "   9   3\n", "   9   0\n");
  const MeasuredFunctions measured =
      read(unknown + coherence + "    -1\n" + zero_direction + in_double, 1.0);
  ASSERT_EQ(measured.functions.size(), 1U);
  std::string notes;
  for (const std::string& note : measured.notes) notes += note + "\n";
  EXPECT_NE(notes.find("1 of function type 6"), std::string::npos) << notes;
  EXPECT_NE(notes.find("1 without node or direction"), std::string::npos) << notes;
  EXPECT_NE(notes.find("datasets not read: 3000"), std::string::npos) << notes;
  EXPECT_NE(notes.find("taken for SI"), std::string::npos) << notes;
  const std::string per_acceleration =
      with(in_double, "\n        13    0    1", "\n        12    0    1");
  EXPECT_NE(refused(per_acceleration).find("no force"), std::string::npos);
}

TEST_F(MeasuredFunctionsFile, RefusesByItsLineWhatBreaksTheFormat)
{
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::string& words) {
    const std::string message = refused(with(geometry + in_double, from, to));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  expect("  3.000000000000E+00", "  3.000000000000E+xx", ":25: dataset 58: record 12");
  expect("  6.000000000000E+00\n", "\n", ":26: dataset 58: record 12");
  expect("  5.000000000000E+00  6.000000000000E+00\n", "", "ends where record 12 is expected");
  expect("  5.000000000000E+00  6.0", "                 nan  6.0", ":26: ");
  expect("         6         3         1", "         7         3         1",
         ":20: dataset 58: record 7: data type 7");
  expect("         6         3         1", "         6         1         1", "two or more");
  expect("         6         3         1", "         6         3         2", "spacing 2");
  expect("  2.50000E+00", " -2.50000E+00", "positive step");
  expect("   7  -3", "   7  -9", ":19: dataset 58: record 6: direction -9");
  expect("   7  -3", "   7 -3x",
         ":19: dataset 58: record 6: columns 52 to 55 are '-3x', no whole number");
  for (const std::string type : {"        -1", "     10001", "       1.2"})
    expect("        13    0    1    0 Force", type + "    0    1    0 Force", "no data type");
  expect("    58\n", "    58b\n", ":13: ");
  expect("    58\n", binary_head(1, 48) + "\n", ":24: dataset 58b: no line of -1");
  expect("    58\n", "    58b     1     1          11          48\n", "IEEE 754");
  EXPECT_NE(refused(geometry).find("no frequency response"), std::string::npos);
  EXPECT_NE(refused(in_double + with(in_double, "  2.50000E+00", "  2.60000E+00"))
                .find(":18: dataset 58: its 3"),
            std::string::npos);
  EXPECT_NE(
      refused(geometry.substr(geometry.find("    15\n") - 7) + in_double).find("--length-unit"),
      std::string::npos);
}

TEST_F(MeasuredFunctionsFile, IsCutToARangeWithBothEnds)
{
  const MeasuredFunctions measured = read(geometry + in_double);
  const MeasuredFunctions part = within(measured, 10.0, 12.5);
  EXPECT_EQ(part.f_Hz, Eigen::Vector2d(10.0, 12.5));
  EXPECT_EQ(part.functions[0].H[1], measured.functions[0].H[1]);
  const std::string message = error_of([&] { within(measured, 11.0, 14.0); });
  EXPECT_NE(message.find("1 of its frequencies"), std::string::npos) << message;
  EXPECT_NE(error_of([&] { within(measured, 200.0, 300.0); }).find("from_Hz"), std::string::npos);
  MeasuredFunctions silent = measured;
  silent.functions.push_back(measured.functions[0]);
  silent.functions[0].H.head(2).setZero();
  EXPECT_EQ(within(silent, 10.0, 12.5).functions.size(), 1U);
  EXPECT_EQ(within(silent, 10.0, 12.5).notes.size(), 1U);
  silent.functions.pop_back();
  EXPECT_NE(error_of([&] { within(silent, 10.0, 12.5); }).find("zero"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
