#include "mbs_export/formats/formats.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "../wheel.hpp"
#include "common/files/output_file.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "two_nodes.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index, Eigen::MatrixXd;

std::string golden(const std::string& name)
{
  return files::test::bytes_of(CHLADNI_SOURCE_DIR "/tests/data/" + name);
}

std::vector<std::string> lines_of(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Columns first .. first + width - 1 of a card, as Nastran reads it; columns beyond 80 do not
/// exist.
std::string columns(const std::string& line, std::size_t first, std::size_t width)
{
  EXPECT_LE(line.size(), 80u) << line;
  if (line.size() <= first) return "";
  const std::string text = line.substr(first, width);
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

double real_of_column(std::string text)
{
  for (char& c : text)
    if (c == 'D') c = 'E';
  std::size_t used = 0;
  const double x = std::stod(text, &used);
  EXPECT_EQ(used, text.size()) << text;
  return x;
}

using Dof = std::pair<int, int>;

/// The entries of one DMIG matrix, read by columns of the card image.
std::map<std::pair<Dof, Dof>, double> read_dmig(const std::string& text, const std::string& name)
{
  std::map<std::pair<Dof, Dof>, double> entries;
  bool inside = false;
  Dof column{};
  for (const std::string& line : lines_of(text)) {
    const auto dof = [&](std::size_t start) {
      return Dof{std::stoi(columns(line, start, 16)), std::stoi(columns(line, start + 16, 16))};
    };
    if (columns(line, 0, 8) == "DMIG*") {
      inside = columns(line, 8, 16) == name;
      column = dof(24);
    } else if (columns(line, 0, 8) != "*") {
      inside = false;
    } else if (inside) {
      entries[{dof(8), column}] = real_of_column(columns(line, 40, 16));
    }
  }
  return entries;
}

struct Op4 {
  std::string name;
  int form, type;
  MatrixXd A;
};

/// Reads the formatted OP4 layout strictly: widths of 8 and 23, and the closing column.
std::vector<Op4> read_op4(const std::string& text)
{
  std::vector<Op4> matrices;
  const std::vector<std::string> lines = lines_of(text);
  const auto integer = [](const std::string& line, std::size_t i) {
    return std::stoi(line.substr(8 * i, 8));
  };
  for (std::size_t at = 0; at < lines.size();) {
    const std::string& header = lines[at++];
    EXPECT_EQ(header.substr(40), "1P,3E23.16");
    const int n_cols = integer(header, 0);
    Op4 matrix{columns(header, 32, 8), integer(header, 2), integer(header, 3),
               MatrixXd::Zero(integer(header, 1), n_cols)};
    for (int column = 0; column <= n_cols;) {
      const std::string& head = lines.at(at++);
      column = integer(head, 0);
      const int row = integer(head, 1), n = integer(head, 2);
      for (int i = 0; i < n; ++i) {
        if (i > 0 && i % 3 == 0) ++at;
        const double x = real_of_column(columns(lines.at(at), std::size_t(23 * (i % 3)), 23));
        if (column <= n_cols) matrix.A(row - 1 + i, column - 1) = x;
      }
      ++at;
    }
    matrices.push_back(matrix);
  }
  return matrices;
}

/// Of `two_nodes`, in the order of Nastran: z of grid 7, z and ry of grid 8, the modes 9 and 10.
const std::vector<int> nastran_rows{0, 2, 1, 3, 4};
const std::vector<Dof> nastran_dofs{{7, 3}, {8, 3}, {8, 5}, {9, 0}, {10, 0}};

TEST(NastranNumbers, KeepNodeNumbersAndInventTheOthers)
{
  const NastranNumbers numbers = nastran_numbers(test::two_nodes());
  EXPECT_EQ(numbers.grids, (std::vector<int>{8, 7}));
  EXPECT_EQ(numbers.first_spoint, 9);
}

TEST(NastranNumbers, AreUniqueWhereNodeNumbersAreNot)
{
  ReducedSystem system = test::two_nodes();
  system.attachment_nodes[0].number = 7;
  EXPECT_EQ(nastran_numbers(system).grids, (std::vector<int>{7, 8}));
  system.attachment_nodes[0].number = 5'000'000'000;
  EXPECT_EQ(nastran_numbers(system).grids, (std::vector<int>{8, 7}));
}

TEST(NastranDmig, ReturnsTheMatricesToTheTenDigitsOfAField)
{
  const ReducedSystem system = test::two_nodes();
  const std::string text = nastran_dmig(system);
  for (const auto& [name, A] : {std::pair{"KRED", system.K}, std::pair{"MRED", system.M}}) {
    const auto entries = read_dmig(text, name);
    Index n_entries = 0;
    for (Index j = 0; j < 5; ++j)
      for (Index i = j; i < 5; ++i) {
        const double expected = A(nastran_rows[std::size_t(i)], nastran_rows[std::size_t(j)]);
        const auto found =
            entries.find({nastran_dofs[std::size_t(i)], nastran_dofs[std::size_t(j)]});
        if (expected == 0.0) continue;
        ++n_entries;
        ASSERT_NE(found, entries.end()) << name << i << j;
        // Half a unit in the tenth digit.
        EXPECT_NEAR(found->second, expected, 0.5001e-9 * std::abs(expected) * 10.0);
      }
    EXPECT_EQ(Index(entries.size()), n_entries) << name;
  }
}

TEST(NastranDmig, IsTheSameTextAsBefore)
{
  EXPECT_EQ(nastran_dmig(test::two_nodes()), golden("two_nodes.dmig"));
}

TEST(NastranDmig, WritesTheSymmetricExampleThatOtherProgramsRead)
{
  // The matrix of the documentation of pyYeti's wtdmig: grid 100, components 1, 2, 6.
  ReducedSystem system{};
  system.attachment_nodes = {{100, {0, 0, 0}}};
  system.masters = {{0, 0}, {0, 1}, {0, 5}};
  system.K = system.M = MatrixXd(3, 3);
  system.K << 3.5, -1.2, -2.4, -1.2, 8.8, 6.5, -2.4, 6.5, 9.9;
  system.M = system.K;
  const std::string expected =
      "DMIG    KRED           0       6       2       0       0               3\n"
      "DMIG*   KRED                         100               1\n"
      "*                    100               1 3.500000000D+00\n"
      "*                    100               2-1.200000000D+00\n"
      "*                    100               6-2.400000000D+00\n"
      "DMIG*   KRED                         100               2\n"
      "*                    100               2 8.800000000D+00\n"
      "*                    100               6 6.500000000D+00\n"
      "DMIG*   KRED                         100               6\n"
      "*                    100               6 9.900000000D+00\n";
  EXPECT_NE(nastran_dmig(system).find(expected), std::string::npos);
}

TEST(NastranDmig, ConstrainsComponentsThatAreNoMasters)
{
  std::vector<std::string> constrained;
  bool in_grid = false;
  for (const std::string& line : lines_of(nastran_dmig(test::two_nodes()))) {
    if (in_grid) constrained.push_back(columns(line, 40, 16));
    in_grid = columns(line, 0, 8) == "GRID*";
  }
  EXPECT_EQ(constrained, (std::vector<std::string>{"12456", "1246"}));
}

TEST(NastranDmig, RefusesWhatItsFieldsCannotHold)
{
  ReducedSystem system = test::two_nodes();
  system.C = system.K;
  system.C(0, 1) *= 2.0;
  EXPECT_NE(files::test::error_of([&] { nastran_dmig(system); }).find("not symmetric"),
            std::string::npos);
  system.C.resize(0, 0);
  system.K(0, 0) = 1e120;
  EXPECT_NE(files::test::error_of([&] { nastran_dmig(system); }).find("1e+120"), std::string::npos);
}

TEST(Op4, ReturnsEveryDigit)
{
  MatrixXd A = MatrixXd::Random(7, 4) / 3.0;
  A.col(1).setZero();
  A(0, 2) = A(6, 2) = 0.0;
  A(3, 3) = std::numeric_limits<double>::denorm_min();  // becomes zero
  A(4, 3) = -1e98 / 3.0;
  const std::vector<Op4> read = read_op4(op4_matrix("A", A, MatrixForm::rectangular));
  ASSERT_EQ(read.size(), 1u);
  A(3, 3) = 0.0;
  EXPECT_EQ(read[0].A, A);
  EXPECT_EQ(read[0].form, 2);
  EXPECT_EQ(read[0].type, 2);
}

TEST(NastranSuperelement, ReturnsTheMatricesBitByBitInTheOrderOfNastran)
{
  ReducedSystem system = test::two_nodes();
  system.C = 1e-5 / 3.0 * system.K;
  const std::vector<Op4> read = read_op4(nastran_superelement(system, 100).op4);
  ASSERT_EQ(read.size(), 23u);
  EXPECT_EQ(read[0].name, "KAA");
  EXPECT_EQ(read[0].A, MatrixXd(system.K(nastran_rows, nastran_rows)));
  EXPECT_EQ(read[0].form, 6);
  EXPECT_EQ(read[1].A, MatrixXd(system.M(nastran_rows, nastran_rows)));
  EXPECT_EQ(read[2].name, "BAA");
  EXPECT_EQ(read[2].A, MatrixXd(system.C(nastran_rows, nastran_rows)));
  EXPECT_EQ(read[3].A, MatrixXd(MatrixXd::Zero(1, 1)));
  EXPECT_EQ(read[8].name, "VA");
  EXPECT_EQ(read[8].A, MatrixXd(MatrixXd::Ones(5, 1)));
}

TEST(NastranSuperelement, IsTheSameTextAsBefore)
{
  const NastranSuperelement files = nastran_superelement(test::two_nodes(), 100);
  EXPECT_EQ(files.op4, golden("two_nodes.op4"));
  EXPECT_EQ(files.assembly, golden("two_nodes.asm"));
  EXPECT_EQ(files.superelement, golden("two_nodes.pch"));
}

/// All small fields of the cards of one name, with their continuations.
std::vector<std::string> fields_of(const std::string& text, const std::string& name)
{
  std::vector<std::string> fields;
  bool inside = false;
  for (const std::string& line : lines_of(text)) {
    const std::string first = columns(line, 0, 8);
    inside = first == name || (inside && first.empty());
    if (!inside) continue;
    for (std::size_t i = 1; i <= 8; ++i)
      if (const std::string text_i = columns(line, 8 * i, 8); !text_i.empty())
        fields.push_back(text_i);
  }
  return fields;
}

TEST(NastranSuperelement, NamesEveryRowOfItsMatricesOnce)
{
  const NastranSuperelement files = nastran_superelement(test::wheel(), 12);
  const std::vector<std::string> external = fields_of(files.superelement, "EXTRN");
  ASSERT_EQ(external.size(), 2u * (test::wheel_rim_nodes + 1));
  for (std::size_t i = 0; i < external.size(); i += 2) {
    EXPECT_EQ(external[i], std::to_string(100 + i / 2));
    EXPECT_EQ(external[i + 1], "123456");
  }
  EXPECT_EQ(fields_of(files.superelement, "ASET"), external);
  const std::vector<std::string> pairs = fields_of(files.assembly, "SECONCT");
  ASSERT_EQ(pairs.size(), 3u + external.size());  // SEIDA, SEIDB, LOC, then the pairs
  EXPECT_EQ(pairs[3], "100");
  EXPECT_EQ(pairs[4], "100");
  EXPECT_EQ(fields_of(files.assembly, "SEBULK"),
            (std::vector<std::string>{"12", "EXTOP4", "MANUAL", "12"}));
}

// Readers of bulk data (pyNastran) know no THRU on this card.
TEST(NastranSuperelement, WritesThePairsOfScalarPointsOut)
{
  const std::string assembly = nastran_superelement(test::two_nodes(), 100).assembly;
  const std::vector<std::string> pairs = fields_of(assembly, "SECONCT");
  EXPECT_EQ(std::ranges::count(pairs, "THRU"), 0);
  EXPECT_EQ((std::vector<std::string>{pairs.end() - 4, pairs.end()}),
            (std::vector<std::string>{"9", "9", "10", "10"}));
}

TEST(NastranSuperelement, RefusesNumbersThatAreNone)
{
  EXPECT_FALSE(files::test::error_of([] { nastran_superelement(test::two_nodes(), 0); }).empty());
}

TEST(WriteText, ReplacesAFileOrLeavesItAsItWas)
{
  const files::test::ScratchFolder folder;
  files::write_text(folder.file("a.txt"), "old");
  files::write_text(folder.file("a.txt"), "new");
  EXPECT_EQ(files::test::bytes_of(folder.file("a.txt")), "new");
  EXPECT_NE(files::test::error_of([&] {
              files::write_text(folder.file("none/a.txt"), "x");
            }).find("none/a.txt"),
            std::string::npos);
  const auto n_files = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(n_files, 1);
}

}  // namespace
}  // namespace chladni::mbs_export::formats
