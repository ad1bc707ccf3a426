#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "common/error.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/formats/export_error.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::MatrixXd;

namespace {

using Fields = std::vector<std::string>;

/// A DOF of Nastran: grid and component 1..6, or scalar point and 0.
struct NastranDof {
  int id;
  int component;
};

/// The system in the order of Nastran: by ascending grid and component, then the scalar points.
struct Ordered {
  std::vector<NastranDof> dofs;
  std::vector<int> rows;  ///< of K_r
};

std::string field(int number)
{
  return fmt::format("{}", number);
}

/// A card in small fields, eight to a line.
std::string card(const std::string& name, const Fields& fields)
{
  std::string text, line = fmt::format("{:<8}", name);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    assert(fields[i].size() <= 8);
    line += fmt::format("{:>8}", fields[i]);
    if (i % 8 != 7 && i + 1 != fields.size()) continue;
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    line = "        ";
  }
  return text;
}

std::string rule(const std::string& title)
{
  return fmt::format("$\n$ {}\n$\n", title);
}

Ordered in_nastran_order(const ReducedSystem& reduced, const NastranNumbers& numbers)
{
  const auto n_m = static_cast<std::size_t>(reduced.n_masters());
  std::vector<NastranDof> dofs;
  for (const MasterDof& dof : reduced.masters)
    dofs.push_back({numbers.grids[std::size_t(dof.node)], dof.component + 1});
  for (Index i = 0; i < reduced.fixed_interface_frequencies.size(); ++i)
    dofs.push_back({numbers.first_spoint + static_cast<int>(i), 0});
  Ordered ordered{.dofs = {}, .rows = std::vector<int>(dofs.size())};
  std::iota(ordered.rows.begin(), ordered.rows.end(), 0);
  std::sort(ordered.rows.begin(), ordered.rows.begin() + static_cast<std::ptrdiff_t>(n_m),
            [&](int a, int b) {
              const NastranDof &x = dofs[std::size_t(a)], &y = dofs[std::size_t(b)];
              return std::pair(x.id, x.component) < std::pair(y.id, y.component);
            });
  for (const int row : ordered.rows) ordered.dofs.push_back(dofs[std::size_t(row)]);
  return ordered;
}

/// Attachment nodes by ascending grid.
std::vector<int> nodes_by_grid(const NastranNumbers& numbers)
{
  std::vector<int> nodes(numbers.grids.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::ranges::sort(nodes, {}, [&](int node) { return numbers.grids[std::size_t(node)]; });
  return nodes;
}

enum class Components { masters, others };

/// "123456" or what of it the node has as masters, or has not.
std::string components_of(const ReducedSystem& reduced, int node, Components wanted)
{
  std::array<bool, 6> is_master{};
  for (const MasterDof& dof : reduced.masters)
    if (dof.node == node) is_master[std::size_t(dof.component)] = true;
  std::string digits;
  for (std::size_t c = 0; c < 6; ++c)
    if (is_master[c] == (wanted == Components::masters)) digits += static_cast<char>('1' + c);
  return digits;
}

std::string grid_cards(const ReducedSystem& reduced, const NastranNumbers& numbers)
{
  std::string text;
  for (const int node : nodes_by_grid(numbers)) {
    const Eigen::Vector3d& x = reduced.attachment_nodes[std::size_t(node)].position;
    text += fmt::format("GRID*   {:16}{:16}{:16.9E}{:16.9E}\n*       {:16.9E}{:16}{:>16}\n",
                        numbers.grids[std::size_t(node)], 0, x[0], x[1], x[2], 0,
                        components_of(reduced, node, Components::others));
  }
  return text;
}

/// ID1 THRU ID2, or one ID.
Fields spoint_range(const ReducedSystem& reduced, const NastranNumbers& numbers)
{
  const auto n = static_cast<int>(reduced.fixed_interface_frequencies.size());
  if (n == 1) return {field(numbers.first_spoint)};
  return {field(numbers.first_spoint), "THRU", field(numbers.first_spoint + n - 1)};
}

std::string spoint_card(const ReducedSystem& reduced, const NastranNumbers& numbers)
{
  if (reduced.fixed_interface_frequencies.size() == 0) return "";
  return rule("FIXED-INTERFACE MODES") + card("SPOINT", spoint_range(reduced, numbers));
}

void require_writable(const ReducedSystem& reduced)
{
  if (reduced.ring_motion && reduced.sector_harmonics) {
    throw ExportError("mesh.sectors",
                      "Nastran: its grids have displacements as coordinates, not the harmonics of "
                      "sectors; mesh the "
                      "whole body, with sectors = 1 if it was found to repeat, and reduce again");
  }
  if (reduced.ring_motion) {
    throw ExportError(
        "interface.rings",
        "Nastran: its grids have displacements as coordinates, not harmonics of a ring; take the "
        "rings out of interface.rings and reduce again");
  }
  if (reduced.C.size() > 0 && check_parts::asymmetry(reduced.C) > 1e-8)
    throw Error("Nastran: the damping matrix is not symmetric; B2GG and BAA must be");
}

/// In a field of 16: exponents of two digits, D for double precision.
std::string dmig_real(double x)
{
  if (!std::isfinite(x) || std::abs(x) > 1e99)
    throw Error(fmt::format("Nastran: DMIG cannot hold the entry {}", x));
  std::string text = fmt::format("{:16.9E}", x);
  std::ranges::replace(text, 'E', 'D');
  return text;
}

/// The lower triangle of a symmetric matrix by columns.
std::string dmig_matrix(const std::string& name, const MatrixXd& A, const Ordered& ordered)
{
  const MatrixXd values = A(ordered.rows, ordered.rows);
  constexpr int symmetric = 6, real_double = 2, of_the_machine = 0, real_and_imaginary = 0;
  std::string text =
      card("DMIG", {name, "0", field(symmetric), field(real_double), field(of_the_machine),
                    field(real_and_imaginary), "", field(static_cast<int>(A.cols()))});
  text.replace(8, 8, fmt::format("{:<8}", name));  // names stand flush left
  for (Index j = 0; j < values.cols(); ++j) {
    std::string column;
    for (Index i = j; i < values.rows(); ++i) {
      if (std::abs(values(i, j)) < 1e-99) continue;
      const NastranDof& dof = ordered.dofs[std::size_t(i)];
      fmt::format_to(std::back_inserter(column), "*       {:16}{:16}{}\n", dof.id, dof.component,
                     dmig_real(values(i, j)));
    }
    if (column.empty()) continue;
    const NastranDof& dof = ordered.dofs[std::size_t(j)];
    text += fmt::format("DMIG*   {:<16}{:16}{:16}\n", name, dof.id, dof.component) + column;
  }
  return text;
}

/// What the assembly run reads from the OP4 file, in its order; all but the first three and VA are
/// absent here, which is a 1 x 1 zero.
std::string op4_file(const ReducedSystem& reduced, const Ordered& ordered)
{
  const MatrixXd zero = MatrixXd::Zero(1, 1);
  const Index n = reduced.K.rows();
  const auto matrix = [&](const std::string& name, const MatrixXd& A) {
    return op4_matrix(name, A.size() > 0 ? MatrixXd(A(ordered.rows, ordered.rows)) : zero,
                      MatrixForm::symmetric);
  };
  std::string text = matrix("KAA", reduced.K) + matrix("MAA", reduced.M) + matrix("BAA", reduced.C);
  for (const char* name : {"K4XX", "PA", "GPXX", "GDXX", "RVAX"})
    text += op4_matrix(name, zero, MatrixForm::symmetric);
  text += op4_matrix("VA", MatrixXd::Ones(n, 1), MatrixForm::rectangular);
  for (const char* name : {"MUG1", "MUG1O", "MES1", "MES1O", "MEE1", "MEE1O", "MGPF", "MGPFO",
                           "MEF1", "MEF1O", "MQG1", "MQG1O", "MQMG1", "MQMG1O"})
    text += op4_matrix(name, zero, MatrixForm::symmetric);
  return text;
}

std::string assembly_file(const ReducedSystem& reduced, const NastranNumbers& numbers, int number)
{
  const std::string se = field(number);
  std::string text = fmt::format(
      "$ SUPERELEMENT {}: INCLUDE IN THE MAIN BULK DATA. AT THE TOP OF THE DECK:\n"
      "$ ASSIGN INPUTT4='NAME.op4',UNIT={},FORM=FORMATTED\n$\n",
      number, number);
  text += card("SEBULK", {se, "EXTOP4", "", "MANUAL", "", "", se});
  Fields pairs{se, "0", "", "NO", "", "", "", ""};
  for (const int node : nodes_by_grid(numbers)) {
    pairs.push_back(field(numbers.grids[std::size_t(node)]));
    pairs.push_back(pairs.back());
  }
  text += card("SECONCT", pairs) + rule("ATTACHMENT NODES") + grid_cards(reduced, numbers);
  const auto n_modes = static_cast<int>(reduced.fixed_interface_frequencies.size());
  if (n_modes == 0) return text;
  // Written out: readers of bulk data know no THRU on this card.
  Fields scalar{se, "0", "", "NO", "", "", "", ""};
  for (int i = 0; i < n_modes; ++i) scalar.insert(scalar.end(), 2, field(numbers.first_spoint + i));
  return text + spoint_card(reduced, numbers) + card("SECONCT", scalar);
}

std::string superelement_file(const ReducedSystem& reduced, const NastranNumbers& numbers,
                              int number)
{
  const auto n_modes = static_cast<int>(reduced.fixed_interface_frequencies.size());
  Fields external, analysis;
  for (const int node : nodes_by_grid(numbers)) {
    external.push_back(field(numbers.grids[std::size_t(node)]));
    external.push_back(components_of(reduced, node, Components::masters));
  }
  std::string sets;
  for (std::size_t i = 0; i < external.size(); i += 2)
    sets += card("ASET", {external[i], external[i + 1]});
  for (int i = 0; i < n_modes; ++i) {
    external.push_back(field(numbers.first_spoint + i));
    external.emplace_back("0");
  }
  if (n_modes > 0) {
    Fields modal{"0"};
    std::ranges::copy(spoint_range(reduced, numbers), std::back_inserter(modal));
    sets += card("QSET1", modal);
  }
  return fmt::format("$ SUPERELEMENT {}: INCLUDE AT THE END, BEFORE ENDDATA\n$\n", number) +
         fmt::format("BEGIN SUPER{:8}\n$\n", number) + card("EXTRN", external) +
         rule("ATTACHMENT NODES") + grid_cards(reduced, numbers) + rule("ANALYSIS SET") + sets +
         spoint_card(reduced, numbers);
}

}  // namespace

NastranNumbers nastran_numbers(const ReducedSystem& reduced)
{
  constexpr int largest = 89'999'999;  // what remains of eight digits is for others
  NastranNumbers numbers{.grids = {}, .first_spoint = 0};
  std::set<std::int64_t> taken;
  int last = 0;
  for (const AttachmentNode& node : reduced.attachment_nodes) {
    const bool own = node.number >= 1 && node.number <= largest && taken.insert(node.number).second;
    numbers.grids.push_back(own ? static_cast<int>(node.number) : 0);
    last = std::max(last, numbers.grids.back());
  }
  for (int& grid : numbers.grids)
    if (grid == 0) grid = ++last;
  numbers.first_spoint = last + 1;
  return numbers;
}

std::string nastran_dmig(const ReducedSystem& reduced)
{
  require_writable(reduced);
  const NastranNumbers numbers = nastran_numbers(reduced);
  const Ordered ordered = in_nastran_order(reduced, numbers);
  std::string text = "$ REDUCED SYSTEM IN SI UNITS. CASE CONTROL:\n$ K2GG = KRED\n$ M2GG = MRED\n";
  if (reduced.C.size() > 0) text += "$ B2GG = BRED\n";
  text += rule("ATTACHMENT NODES") + grid_cards(reduced, numbers) + spoint_card(reduced, numbers);
  text += rule("STIFFNESS") + dmig_matrix("KRED", reduced.K, ordered);
  text += rule("MASS") + dmig_matrix("MRED", reduced.M, ordered);
  if (reduced.C.size() > 0) text += rule("DAMPING") + dmig_matrix("BRED", reduced.C, ordered);
  return text;
}

NastranSuperelement nastran_superelement(const ReducedSystem& reduced, int number)
{
  if (number < 1 || number > 9999)
    throw Error(fmt::format("Nastran: {} is no number for a superelement; 1 .. 9999 are", number));
  require_writable(reduced);
  const NastranNumbers numbers = nastran_numbers(reduced);
  return {.op4 = op4_file(reduced, in_nastran_order(reduced, numbers)),
          .assembly = assembly_file(reduced, numbers, number),
          .superelement = superelement_file(reduced, numbers, number)};
}

namespace {

constexpr int real_double = 2;

/// First and last row that are not zero; last < first for a column of zeros.
struct Rows {
  Index first, last;
};

Rows nonzero_rows(const Eigen::VectorXd& column)
{
  Rows rows{0, column.size() - 1};
  while (rows.first <= rows.last && column[rows.first] == 0.0) ++rows.first;
  while (rows.last >= rows.first && column[rows.last] == 0.0) --rows.last;
  return rows;
}

void append_values(std::string& text, const Eigen::VectorXd& values)
{
  constexpr Index per_line = 3;
  for (Index i = 0; i < values.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:23.16E}", values[i]);
    if (i % per_line == per_line - 1 || i == values.size() - 1) text += '\n';
  }
}

/// Exponents have two digits.
Eigen::MatrixXd writable(const std::string& name, const Eigen::MatrixXd& A)
{
  if (!A.allFinite() || A.cwiseAbs().maxCoeff() > 1e99)
    throw Error(fmt::format("{}: an entry is not finite or above 1e99; OP4 cannot hold it", name));
  return (A.array().abs() < 1e-99).select(0.0, A);
}

}  // namespace

std::string op4_matrix(const std::string& name, const Eigen::MatrixXd& A, MatrixForm form)
{
  const Eigen::MatrixXd values = writable(name, A);
  std::string text = fmt::format("{:8}{:8}{:8}{:8}{:<8}1P,3E23.16\n", A.cols(), A.rows(),
                                 static_cast<int>(form), real_double, name);
  for (Index j = 0; j < A.cols(); ++j) {
    const auto [first, last] = nonzero_rows(values.col(j));
    const Index n = last - first + 1;
    if (n <= 0) continue;
    text += fmt::format("{:8}{:8}{:8}\n", j + 1, first + 1, n);
    append_values(text, values.col(j).segment(first, n));
  }
  // The column after the last one ends the matrix; its value is never used.
  text += fmt::format("{:8}{:8}{:8}\n", A.cols() + 1, 1, 1);
  append_values(text, Eigen::VectorXd::Constant(1, std::sqrt(2.0)));
  return text;
}

}  // namespace chladni::mbs_export::formats
