#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
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

/// The sets of attachment nodes, whose names stand in comments.
std::string set_cards(const ReducedSystem& reduced, const NastranNumbers& numbers)
{
  std::string text = rule("SETS OF ATTACHMENT NODES");
  for (std::size_t i = 0; i < reduced.sets.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    Fields fields{field(number)};
    for (const int node : reduced.sets[i].nodes)
      fields.push_back(field(numbers.grids[std::size_t(node)]));
    text += fmt::format("$ SET {}: {}\n", number, reduced.sets[i].name) + card("SET1", fields);
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
         rule("ATTACHMENT NODES") + grid_cards(reduced, numbers) + set_cards(reduced, numbers) +
         rule("ANALYSIS SET") + sets + spoint_card(reduced, numbers);
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
  text += rule("ATTACHMENT NODES") + grid_cards(reduced, numbers) + set_cards(reduced, numbers) +
          spoint_card(reduced, numbers);
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

namespace {

/// What stands before the columns of a matrix.
struct Op4Header {
  std::string name;
  std::int64_t columns, rows;  ///< rows are negative with BIGMAT
  std::int64_t type;           ///< 1, 2 real, 3, 4 complex; single, double
  int per_line = 5, width = 16;

  int words() const { return type % 2 == 0 ? 2 : 1; }
};

/// Strings of values, which both kinds of files have.
class Op4Reader {
 public:
  virtual ~Op4Reader() = default;
  /// Nothing at the end of the file.
  virtual std::optional<Op4Header> header() = 0;
  /// The three numbers that begin a column: column, row (0 if sparse), number of words.
  virtual std::array<std::int64_t, 3> column(const Op4Header& header) = 0;
  /// n integers within a column.
  virtual std::array<std::int64_t, 2> integers(int n) = 0;
  virtual std::vector<double> values(const Op4Header& header, std::int64_t n) = 0;
  virtual void end_column() = 0;
  /// The number of values that n words of a dense column are.
  virtual std::int64_t values_of_dense(const Op4Header& header, std::int64_t n) const = 0;
  [[noreturn]] virtual void refuse(const std::string& why) const = 0;
};

class FormattedOp4 final : public Op4Reader {
 public:
  explicit FormattedOp4(const std::string& text) : text_(text) {}

  std::optional<Op4Header> header() override
  {
    if (text_.find_first_not_of(" \r\n", at_) == std::string::npos) return std::nullopt;
    const std::string line = next_line();
    Op4Header header{.name = trimmed_name(line.substr(std::min<std::size_t>(32, line.size()), 8)),
                     .columns = number(line, 0),
                     .rows = number(line, 8),
                     .type = number(line, 24)};
    const std::size_t E = line.find_first_of("ED", 40), dot = line.find('.', 40);
    if (E != std::string::npos && dot != std::string::npos && dot > E) {
      const std::size_t comma = line.find(',', 40);
      const std::size_t from = comma == std::string::npos || comma > E ? 40 : comma + 1;
      header.per_line = static_cast<int>(whole(line.substr(from, E - from)));
      header.width = static_cast<int>(whole(line.substr(E + 1, dot - E - 1)));
    }
    if (header.per_line < 1 || header.width < 1) refuse("its format cannot be read");
    return header;
  }
  std::array<std::int64_t, 3> column(const Op4Header&) override
  {
    const std::string line = next_line();
    return {number(line, 0), number(line, 8), number(line, 16)};
  }
  std::array<std::int64_t, 2> integers(int n) override
  {
    const std::string line = next_line();
    if (n == 1) return {whole(line), 0};
    return {number(line, 0), number(line, 8)};
  }
  std::vector<double> values(const Op4Header& header, std::int64_t n) override
  {
    std::vector<double> found;
    while (std::ssize(found) < n) {
      const std::string line = next_line();
      for (int k = 0; k < header.per_line && std::ssize(found) < n; ++k) {
        const auto begin = std::size_t(k) * std::size_t(header.width);
        if (begin >= line.size()) refuse("a line of values is cut off");
        std::string field = line.substr(begin, std::size_t(header.width));
        std::ranges::replace(field, 'D', 'E');
        char* end = nullptr;
        found.push_back(std::strtod(field.c_str(), &end));
        if (end == field.c_str() || !std::isfinite(found.back()))
          refuse(fmt::format("\"{}\" is no number", field));
      }
    }
    return found;
  }
  void end_column() override {}
  std::int64_t values_of_dense(const Op4Header&, std::int64_t n) const override { return n; }
  [[noreturn]] void refuse(const std::string& why) const override
  {
    throw Error(fmt::format("line {}: {}", line_, why));
  }

 private:
  std::string next_line()
  {
    ++line_;
    if (at_ >= text_.size()) refuse("the file ends within a matrix");
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at_ = end + 1;
    return line;
  }
  std::int64_t whole(const std::string& field) const
  {
    char* end = nullptr;
    const long long value = std::strtoll(field.c_str(), &end, 10);
    if (end == field.c_str()) refuse(fmt::format("\"{}\" is no whole number", field));
    return value;
  }
  /// Of eight columns.
  std::int64_t number(const std::string& line, std::size_t first) const
  {
    return whole(line.size() > first ? line.substr(first, 8) : "");
  }
  static std::string trimmed_name(std::string name)
  {
    std::erase(name, ' ');
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// Records of Fortran: 4 bytes before and behind each tell its length.
class BinaryOp4 final : public Op4Reader {
 public:
  BinaryOp4(const std::string& bytes, bool is_swapped) : bytes_(bytes), is_swapped_(is_swapped) {}

  std::optional<Op4Header> header() override
  {
    if (at_ >= bytes_.size()) return std::nullopt;
    begin_record();
    Op4Header header{};
    header.columns = integer();
    header.rows = integer();
    integer();  // form
    header.type = integer();
    for (int k = 0; k < 8; ++k) {
      const char c = take<char>();
      if (c != ' ' && c != '\0')
        header.name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    end_column();
    return header;
  }
  std::array<std::int64_t, 3> column(const Op4Header&) override
  {
    begin_record();
    const std::int64_t column = integer(), row = integer(), n = integer();
    return {column, row, n};
  }
  std::array<std::int64_t, 2> integers(int n) override
  {
    const std::int64_t first = integer();
    return {first, n > 1 ? integer() : 0};
  }
  std::vector<double> values(const Op4Header& header, std::int64_t n) override
  {
    if (n < 0 || std::size_t(n) > (bytes_.size() - at_) / 4)
      refuse("the file ends within a matrix");
    std::vector<double> found;
    for (std::int64_t i = 0; i < n; ++i) {
      found.push_back(header.words() == 2 ? take<double>() : double(take<float>()));
      if (!std::isfinite(found.back())) refuse("an entry is not finite");
    }
    return found;
  }
  void end_column() override
  {
    if (record_end_ < at_) refuse("a record is shorter than what it holds");
    at_ = record_end_;
    if (take<std::int32_t>() != length_) refuse("a record ends otherwise than it begins");
  }
  std::int64_t values_of_dense(const Op4Header& header, std::int64_t n) const override
  {
    return n / header.words();
  }
  [[noreturn]] void refuse(const std::string& why) const override
  {
    throw Error(fmt::format("byte {}: {}", at_, why));
  }

 private:
  template <typename T>
  T take()
  {
    if (bytes_.size() - at_ < sizeof(T)) refuse("the file ends within a matrix");
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (is_swapped_) std::ranges::reverse(raw);
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }
  std::int64_t integer() { return take<std::int32_t>(); }
  void begin_record()
  {
    length_ = take<std::int32_t>();
    if (length_ < 0 || std::size_t(length_) > bytes_.size() - at_)
      refuse("a record is longer than the file");
    record_end_ = at_ + std::size_t(length_);
  }

  const std::string& bytes_;
  bool is_swapped_;
  std::size_t at_ = 0, record_end_ = 0;
  std::int32_t length_ = 0;
};

std::unique_ptr<Op4Reader> op4_reader(const std::string& bytes)
{
  constexpr std::int32_t header = 24;  // bytes of the record that begins a matrix
  std::int32_t first = 0;
  if (bytes.size() >= sizeof(first)) std::memcpy(&first, bytes.data(), sizeof(first));
  if (first == header) return std::make_unique<BinaryOp4>(bytes, false);
  if (first == 2 * header || first == 2 * header << 24)
    throw Error("is of integers of 64 bits; write it with integers of 32 bits, or formatted");
  if (first == header << 24) return std::make_unique<BinaryOp4>(bytes, true);
  return std::make_unique<FormattedOp4>(bytes);
}

/// Adds a string of values to a column; a matrix that nobody wants has no rows.
void put(Op4Reader& reader, MatrixXd& A, Index row, Index column, const std::vector<double>& values)
{
  if (A.size() == 0) return;
  if (row < 0 || column < 0 || column >= A.cols() || row + std::ssize(values) > A.rows())
    reader.refuse("an entry is outside of the matrix");
  A.col(column).segment(row, std::ssize(values)) =
      Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// The strings of a sparse column. The number that begins one is row + 65536 (words + 1), or there
/// are two: words + 1, and the row.
void read_strings(Op4Reader& reader, const Op4Header& header, Index column, std::int64_t n_words,
                  MatrixXd& A)
{
  constexpr std::int64_t largest = 65535;
  const bool is_big = header.rows < 0 || header.rows > largest;
  while (n_words > 0) {
    const auto [first, second] = reader.integers(is_big ? 2 : 1);
    const std::int64_t words = is_big ? first - 1 : first / (largest + 1) - 1;
    const std::int64_t row = is_big ? second : first % (largest + 1);
    if (words < 1) reader.refuse("a string of values is empty");
    put(reader, A, row - 1, column, reader.values(header, words / header.words()));
    n_words -= words + (is_big ? 2 : 1);
  }
}

MatrixXd read_matrix(Op4Reader& reader, const Op4Header& header, bool is_wanted)
{
  constexpr std::int64_t most = 50'000;
  const std::int64_t rows = std::abs(header.rows);
  if (is_wanted && (rows > most || header.columns > most || header.columns < 1))
    reader.refuse(fmt::format("{} is {} x {}", header.name, rows, header.columns));
  if (is_wanted && header.type > 2)
    reader.refuse(header.name + " is complex; real stiffness, mass and damping can be read");
  MatrixXd A;
  if (is_wanted) A.setZero(rows, header.columns);
  while (true) {
    const auto [column, row, n] = reader.column(header);
    const bool is_end = column > header.columns;
    if (column < 1 || n < 0) reader.refuse("no column begins here");
    if (row == 0 && !is_end)
      read_strings(reader, header, column - 1, n, A);
    else if (const auto values = reader.values(header, reader.values_of_dense(header, n)); !is_end)
      put(reader, A, row - 1, column - 1, values);
    reader.end_column();
    if (is_end) return A;
  }
}

}  // namespace

std::vector<Op4Matrix> read_op4(const std::string& bytes, const std::set<std::string>& wanted)
{
  const std::unique_ptr<Op4Reader> reader = op4_reader(bytes);
  std::vector<Op4Matrix> found;
  while (const std::optional<Op4Header> header = reader->header()) {
    const bool is_wanted = wanted.contains(header->name);
    MatrixXd A = read_matrix(*reader, *header, is_wanted);
    if (is_wanted) found.push_back({.name = header->name, .A = std::move(A)});
  }
  return found;
}

}  // namespace chladni::mbs_export::formats
