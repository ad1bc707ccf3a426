#include "mbs_export/measured/function_58.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "mbs_export/measured/universal_fields.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

constexpr int frequency_response = 4;          // function type
constexpr std::array motion_types{8, 11, 12};  // data types: displacement, velocity, acceleration

/// Record 7: how the values are written.
struct ValueForm {
  bool is_double, is_complex, is_even;
  Index n;
  double first, step;  ///< of even abscissas

  /// Numbers of each frequency, its own included where frequencies are uneven.
  Index n_numbers() const { return (is_complex ? 2 : 1) + (is_even ? 0 : 1); }
};

ValueForm read_value_form(RecordReader& records, const UniversalDataset& dataset)
{
  const std::vector<std::int64_t> form = records.fields("record 7", {{0, 10}, {10, 10}, {20, 10}});
  const auto refuse = [&](const std::string& what) { records.fail("record 7: " + what); };
  const std::int64_t type = form[0], n = form[1], spacing = form[2];
  if (type != 2 && type != 4 && type != 5 && type != 6) {
    refuse(
        fmt::format("data type {}; values are 2 or 4 (real, single or double precision) or 5 or "
                    "6 (complex)",
                    type));
  }
  if (spacing != 0 && spacing != 1)
    refuse(fmt::format("abscissa spacing {}; it is 0 (uneven) or 1 (even)", spacing));
  const std::string& line = dataset.lines[6];
  const auto first = real_in(field_of(line, 30, 13)), step = real_in(field_of(line, 43, 13));
  if (spacing == 1 && (!first || !step || !(*step > 0.0) || *first < 0.0))
    refuse("expected a first frequency and a positive step in columns 31 to 56");
  if (n < 2) refuse(fmt::format("{} values; two or more are needed", n));
  return {.is_double = type == 4 || type == 6,
          .is_complex = type >= 5,
          .is_even = spacing == 1,
          .n = n,
          .first = first.value_or(0.0),
          .step = step.value_or(0.0)};
}

/// Words of a file of any encoding, which files of ours have in UTF-8.
std::string ascii(std::string words)
{
  std::ranges::replace_if(
      words, [](char c) { return c < ' ' || c > '~'; }, '?');
  return words;
}

/// Records 8 to 11: what stands along an axis.
struct DataAxis {
  int type;  ///< specific data type
  std::string unit;
};

DataAxis read_axis(RecordReader& records, const char* what)
{
  const std::string& line = records.line(what);
  const std::string field = field_of(line, 0, 10);
  const auto type = field.empty() ? std::int64_t{0} : integer_in(field);
  if (!type || *type < 0 || *type > 10000)
    records.fail(fmt::format("{}: columns 1 to 10 are '{}', no data type", what, field));
  return {static_cast<int>(*type), ascii(field_of(line, 47, 20))};
}

/// The columns of a line of values in ASCII, at most `n` of them.
std::vector<std::size_t> columns_of(const ValueForm& form, std::size_t n)
{
  if (!form.is_double) return std::vector<std::size_t>(std::min<std::size_t>(n, 6), 13);
  if (form.is_even) return std::vector<std::size_t>(std::min<std::size_t>(n, 4), 20);
  if (form.is_complex) return {13, 20, 20};
  std::vector<std::size_t> columns{13, 20, 13, 20};
  columns.resize(std::min<std::size_t>(n, 4));
  return columns;
}

/// The values of record 12 in ASCII, [n_numbers x n].
Eigen::MatrixXd read_text_values(RecordReader& records, const ValueForm& form)
{
  std::vector<double> numbers;
  const auto n = static_cast<std::size_t>(form.n) * static_cast<std::size_t>(form.n_numbers());
  while (numbers.size() < n) {
    const auto more = records.line_of_reals("record 12", columns_of(form, n - numbers.size()));
    numbers.insert(numbers.end(), more.begin(), more.end());
  }
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), form.n_numbers(), form.n);
}

/// A number of IEEE 754 in bytes of either order.
template <class Real>
double real_of(const char* bytes, bool is_little_endian)
{
  std::array<char, sizeof(Real)> own{};
  std::copy_n(bytes, sizeof(Real), own.begin());
  if (is_little_endian != (std::endian::native == std::endian::little)) std::ranges::reverse(own);
  return std::bit_cast<Real>(own);
}

/// The values of record 12 in bytes, [n_numbers x n].
Eigen::MatrixXd read_binary_values(const RecordReader& records, const ValueForm& form,
                                   const UniversalBytes& binary)
{
  const Index size = form.is_double ? 8 : 4, n = form.n * form.n_numbers();
  if (std::ssize(binary.bytes) != size * n) {
    records.fail(fmt::format("has {} bytes, and record 7 announces {} numbers of {} bytes",
                             binary.bytes.size(), n, size));
  }
  Eigen::MatrixXd values(form.n_numbers(), form.n);
  for (Index i = 0; i < n; ++i) {
    const char* const bytes = binary.bytes.data() + size * i;
    values.data()[i] = form.is_double ? real_of<double>(bytes, binary.is_little_endian)
                                      : real_of<float>(bytes, binary.is_little_endian);
  }
  if (!values.allFinite()) records.fail("has values that are not finite");
  return values;
}

Eigen::VectorXd frequencies_of(const RecordReader& records, const ValueForm& form,
                               const Eigen::MatrixXd& values)
{
  Eigen::VectorXd f_Hz(form.n);
  for (Index i = 0; i < form.n; ++i)
    f_Hz[i] = form.is_even ? form.first + form.step * double(i) : values(0, i);
  if (f_Hz[0] < 0.0 || std::ranges::adjacent_find(f_Hz, std::ranges::greater_equal{}) != f_Hz.end())
    records.fail("expected frequencies of zero or more that ascend");
  return f_Hz;
}

/// What the function is where it is no response to a force; else nothing.
std::string unsuitable(const Function58& one, const DataAxis& abscissa, const DataAxis& ordinate,
                       const DataAxis& denominator)
{
  constexpr int unknown = 0, general = 1, reaction = 9, force = 13, frequency = 18;
  const auto is = [](const DataAxis& axis, std::initializer_list<int> types) {
    return std::ranges::find(types, axis.type) != types.end();
  };
  if (!is(abscissa, {unknown, general, frequency}))
    return fmt::format("over an abscissa of data type {}, no frequency", abscissa.type);
  if (!is(ordinate, {unknown, general, motion_types[0], motion_types[1], motion_types[2]}))
    return fmt::format("of data type {}, no motion", ordinate.type);
  if (!is(denominator, {unknown, general, reaction, force}))
    return fmt::format("for each unit of data type {}, no force", denominator.type);
  if (one.output.direction == 0 || one.load.direction == 0) return "without node or direction";
  return "";
}

std::optional<ResponseQuantity> quantity_of(int type)
{
  if (type == motion_types[0]) return ResponseQuantity::receptance;
  if (type == motion_types[1]) return ResponseQuantity::mobility;
  if (type == motion_types[2]) return ResponseQuantity::accelerance;
  return std::nullopt;
}

UniversalDof read_dof(const RecordReader& records, std::int64_t node, std::int64_t direction)
{
  if (direction < -6 || direction > 6)
    records.fail(fmt::format("record 6: direction {}; directions are -6 to 6", direction));
  return {node, static_cast<int>(direction)};
}

}  // namespace

Function58 read_function_58(RecordReader& records, const UniversalDataset& dataset)
{
  Function58 one;
  one.line = dataset.first_line - 1;
  for (int k = 0; k < 5; ++k) {
    const std::string& line = records.line("a line of words");
    if (k == 0) one.name = ascii(trimmed(line.substr(0, 80)));
  }
  const std::vector<std::int64_t> dofs =
      records.fields("record 6", {{0, 5}, {41, 10}, {51, 4}, {66, 10}, {76, 4}});
  if (dofs[0] != frequency_response) {
    one.why_not = fmt::format("of function type {}, no frequency response", dofs[0]);
    return one;
  }
  one.output = read_dof(records, dofs[1], dofs[2]);
  one.load = read_dof(records, dofs[3], dofs[4]);
  const ValueForm form = read_value_form(records, dataset);
  const DataAxis abscissa = read_axis(records, "record 8"),
                 ordinate = read_axis(records, "record 9"),
                 denominator = read_axis(records, "record 10");
  records.line("record 11");
  one.why_not = unsuitable(one, abscissa, ordinate, denominator);
  if (!one.why_not.empty()) return one;
  one.quantity = quantity_of(ordinate.type);
  one.unit_of_output = ordinate.unit;
  one.unit_of_load = denominator.unit;
  const Eigen::MatrixXd values = dataset.binary ? read_binary_values(records, form, *dataset.binary)
                                                : read_text_values(records, form);
  one.f_Hz = frequencies_of(records, form, values);
  const Index re = form.is_even ? 0 : 1;
  one.H = values.row(re).transpose().cast<std::complex<double>>();
  if (form.is_complex) one.H.imag() = values.row(re + 1).transpose();
  return one;
}

}  // namespace chladni::mbs_export
