#include "mbs_export/measured/measured_modes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "mbs_export/make_body.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/bending_beam.hpp"

namespace chladni::mbs_export {
namespace {

using files::test::error_of, files::test::ScratchFolder;

/// Two nodes in mm, and two modes there: a normal one, and a complex one whose numbers leave no
/// blanks between them.
const std::string metric = R"(    -1
   164
         1SI: mm              2
  1.0000000000000000D+03  1.0000000000000000D+00  1.0000000000000000D+00
  2.7314999999999998D+02
    -1
)";
const std::string nodes = R"(    -1
    15
         7         0         0         1  0.00000E+00  1.00000E+01  0.00000E+00
         9         0         0         1  2.50000E+02  0.00000E+00 -1.00000E+00
    -1
)";
const std::string shape_dataset = R"(    -1
    55
First bending
NONE
NONE
NONE
NONE
         1         2         2         8         2         3
         2         4         1         1
  1.25500E+02  1.00000E+00  0.00000E+00  0.00000E+00
         7
  1.00000E+00  2.00000E+00  3.00000E+00
         9
 -1.00000E+00  0.00000E+00  5.00000E-01
    -1
    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         3         2         8         5         3
         2         6         1         2
 -3.00000E+01  4.00000E+01  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
         7
-1.000000E+00-2.000000E+00-3.000000E+00-4.000000E+00-5.000000E+00-6.000000E+00
         9
  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  1.00000E+00
    -1
)";

class MeasuredModesFile : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  std::string path_ = folder_.file("modes.unv");

  MeasuredModes read(const std::string& text, std::optional<double> metres = {})
  {
    std::ofstream(path_) << text;
    return read_measured_modes(path_, metres);
  }
  std::string refused(const std::string& text)
  {
    return error_of([&] { read(text); });
  }
};

/// The text with one thing changed.
std::string changed(std::string text, const std::string& from, const std::string& to)
{
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(MeasuredModesFile, HasNodesFrequenciesAndShapes)
{
  const MeasuredModes modes = read(metric + nodes + shape_dataset);
  ASSERT_EQ(modes.nodes.size(), 2U);
  EXPECT_EQ(modes.nodes[1].number, 9);
  EXPECT_NEAR(modes.nodes[1].position[0], 0.25, 1e-15);
  EXPECT_NEAR(modes.nodes[1].position[2], -0.001, 1e-15);
  EXPECT_EQ(modes.names[0], "First bending");
  EXPECT_EQ(modes.f_Hz[0], 125.5);
  EXPECT_NEAR(modes.f_Hz[1], 50.0 / (2.0 * std::numbers::pi), 1e-12);
  EXPECT_EQ(modes.shapes(3, 0), -1.0);
  EXPECT_EQ(modes.shapes(2, 1), std::complex<double>(-5.0, -6.0));
  EXPECT_EQ(modes.shapes(5, 1), std::complex<double>(0.0, 1.0));
}

TEST_F(MeasuredModesFile, TakesNodesInTwoLinesAndLengthsOfAGivenUnit)
{
  const std::string wide = R"(    -1
  2411
         7         0         0         1
   0.0000000000000000E+00   1.0000000000000000D+01   0.0000000000000000E+00
         9         0         0         1
   2.5000000000000000E+02   0.0000000000000000E+00  -1.0000000000000000E+00
    -1
)";
  const MeasuredModes modes = read(wide + shape_dataset, 1e-3);
  EXPECT_NEAR(modes.nodes[0].position[1], 0.01, 1e-15);
}

TEST_F(MeasuredModesFile, RefusesWhatItDoesNotKnowByItsLine)
{
  EXPECT_NE(refused(nodes + shape_dataset).find("--length-unit"), std::string::npos);
  EXPECT_NE(refused(metric + shape_dataset).find("node 7"), std::string::npos);
  EXPECT_NE(refused(metric + nodes).find("no mode shapes"), std::string::npos);
  const std::string whole = metric + nodes + shape_dataset;
  EXPECT_NE(refused(changed(whole, "    15\n", "    15b\n")).find(":8: "), std::string::npos);
  EXPECT_NE(refused(changed(whole, "  1.25500E+02", "        1e,25")).find(":21: "),
            std::string::npos);
  EXPECT_NE(refused(whole.substr(0, whole.size() - 7)).find("ends within"), std::string::npos);
  EXPECT_NE(refused("1 2 3\n" + whole).find(":1: "), std::string::npos);
  EXPECT_NE(refused("no datasets\n").find("no universal file"), std::string::npos);
  EXPECT_NE(refused(changed(whole, "         9\n  0.0", "        11\n  0.0")).find("other nodes"),
            std::string::npos);
  const std::string systems = "    -1\n  2420\n         1\n    -1\n";
  EXPECT_EQ(refused(systems + whole), "");
  EXPECT_NE(refused(systems + changed(whole, "7         0", "7         4")).find("global"),
            std::string::npos);
}

TEST_F(MeasuredModesFile, LeavesOutWhatIsNoModeWithANote)
{
  const std::string whole = metric + nodes + shape_dataset;
  EXPECT_TRUE(read(whole).notes.empty());
  const std::string function = "    -1\n    58\na function\n    -1\n";
  const std::string others = function + "    -1\n  2414\n1\n    -1\nwords of people\n" + whole;
  const MeasuredModes beside = read(others);
  EXPECT_EQ(beside.f_Hz.size(), 2);
  ASSERT_EQ(beside.notes.size(), 1U);
  EXPECT_NE(beside.notes[0].find("1 dataset 2414, 1 dataset 58"), std::string::npos)
      << beside.notes[0];
  const MeasuredModes rest = read(changed(whole, "1         2         2", "1         5         2"));
  EXPECT_EQ(rest.f_Hz.size(), 1);
  EXPECT_NE(rest.notes.at(0).find("analysis type 5"), std::string::npos) << rest.notes[0];
  EXPECT_NE(refused(metric + nodes + function).find("no mode shapes"), std::string::npos);
}

ModalBody held_beam()
{
  BodyOptions options;
  options.fixed = {"A"};
  return make_body(test::regression_beam(), options);
}

/// The first three modes of the cantilever at B and C, in z, as a measurement.
MeasuredModes of_held_beam(const ModalBody& body)
{
  MeasuredModes measured;
  measured.f_Hz = body.omega.head(3) / (2.0 * std::numbers::pi);
  measured.shapes = Eigen::MatrixXcd::Zero(6, 3);
  for (int i = 0; i < 2; ++i) {
    const AttachmentNode& node = body.attachment_nodes[static_cast<std::size_t>(i + 1)];
    measured.nodes.push_back({101 + i, node.position + Eigen::Vector3d(0.0, 0.001, 0.0)});
    const Eigen::MatrixXd w = body.attachment_modes.block(6 * (i + 1) + 2, 0, 1, 3);
    measured.shapes.row(3 * i + 2) = w.cast<std::complex<double>>();
  }
  measured.names.assign(3, "");
  return measured;
}

TEST(ModalAssurance, IsOneOfAShapeWithItselfWhateverItsFactor)
{
  const ModalBody body = held_beam();
  MeasuredModes measured = of_held_beam(body);
  measured.shapes.col(1) *= std::complex<double>(-3.0, 2.0);
  const ModalAssurance found = modal_assurance(body, measured, 0.002);
  EXPECT_EQ(found.n_components, 2);  // z at two nodes
  EXPECT_NEAR(found.nodes[0].distance, 0.001, 1e-12);
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(found.mac(k, k), 1.0, 1e-12);
  EXPECT_LE(found.mac.maxCoeff(), 1.0 + 1e-12);
  // Two numbers of each shape: by hand.
  const Eigen::Vector2d a = measured.shapes.col(0).real()(std::array{2, 5}),
                        b = measured.shapes.col(2).real()(std::array{2, 5});
  const double by_hand = std::pow(a.dot(b), 2) / (a.squaredNorm() * b.squaredNorm());
  EXPECT_NEAR(found.mac(0, 2), by_hand, 1e-12);
}

TEST(ModalAssurance, ComparesWithNaturalModesAlone)
{
  BodyOptions options;
  options.fixed = {"A"};
  options.keep.count = 4;
  options.interface_modes = {
      {.kind = InterfaceModes::Kind::irm, .at = "B", .components = {2, 4}, .omega0 = {}}};
  const ModalBody body = make_body(test::regression_beam(), options);
  const auto n_natural =
      std::ranges::count_if(body.kinds, [](ModeKind kind) { return kind != ModeKind::interface; });
  ASSERT_LT(n_natural, body.n_modes());
  const ModalAssurance found = modal_assurance(body, of_held_beam(held_beam()), 0.002);
  EXPECT_EQ(found.mac.cols(), n_natural);
  EXPECT_EQ(found.body_Hz.size(), n_natural);
  for (const int mode : found.modes)
    EXPECT_NE(body.kinds[std::size_t(mode - 1)], ModeKind::interface) << mode;
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(found.mac(k, k), 1.0, 1e-6);
}

TEST(ModalAssurance, RefusesNodesThatAreElsewhereAndShapesThatAreNone)
{
  const ModalBody body = held_beam();
  MeasuredModes measured = of_held_beam(body);
  EXPECT_NE(error_of([&] { modal_assurance(body, measured, 0.0005); }).find("101"),
            std::string::npos);
  MeasuredModes still = of_held_beam(body);
  still.shapes.col(1).setZero();
  EXPECT_NE(error_of([&] { modal_assurance(body, still, 0.002); }).find("measured shape 2 is zero"),
            std::string::npos);
  measured.nodes[1].position = measured.nodes[0].position;
  EXPECT_NE(error_of([&] { modal_assurance(body, measured, 0.002); }).find("102"),
            std::string::npos);
}

/// Fields of a line of fixed columns.
std::string field(const std::string& line, std::size_t first, std::size_t n)
{
  return line.substr(first, n);
}

TEST(UniversalFile, HasAFunctionOfType58ForEachOutputAndLoad)
{
  const ModalBody body = held_beam();
  const FrequencyResponses found =
      frequency_responses(body, {.loads = {{.at = "C", .components = {2}}},
                                 .outputs = {{.at = "B", .components = {2, 4}}},
                                 .range = {.from_Hz = 1.0, .to_Hz = 3.0, .count = 5},
                                 .loss_factor = 0.1});
  std::vector<std::string> lines;
  std::istringstream text(universal_file_of(found));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  std::vector<std::size_t> functions;
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i] == "    58" && lines[i - 1] == "    -1") functions.push_back(i);
  ASSERT_EQ(functions.size(), 2U);
  const std::size_t at = functions[1];
  EXPECT_EQ(lines[at + 1], "B.ry / C.z");
  const std::string dofs = lines[at + 6];
  EXPECT_EQ(field(dofs, 0, 5), "    4");
  EXPECT_EQ(field(dofs, 41, 10), fmt::format("{:10d}", body.attachment_nodes[1].number));
  EXPECT_EQ(field(dofs, 51, 4), "   5");
  EXPECT_EQ(field(dofs, 66, 10), fmt::format("{:10d}", body.attachment_nodes[2].number));
  EXPECT_EQ(field(dofs, 76, 4), "   3");
  EXPECT_EQ(lines[at + 7], "         6         5         1  1.00000E+00  5.00000E-01  0.00000E+00");
  // Four numbers in a line, two in the last one.
  EXPECT_EQ(lines[at + 12].size(), 80U);
  EXPECT_EQ(lines[at + 14].size(), 40U);
  EXPECT_EQ(lines[at + 15], "    -1");
  EXPECT_NEAR(std::stod(field(lines[at + 13], 20, 20)), found.H[0](2, 1).imag(),
              1e-10 * std::abs(found.H[0](2, 1)));
}

TEST(UniversalFile, RefusesALoadOfSeveralNodes)
{
  FrequencyResponses found;
  found.loads.push_back({.name = "track.z", .component = 2, .node = 0, .position = {0, 0, 0}});
  EXPECT_NE(error_of([&] { universal_file_of(found); }).find("track.z"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
