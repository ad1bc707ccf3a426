#include "mbs_export/measured/measured_functions.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/measured/universal_file.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

using Eigen::Index;

namespace {

/// A node and a direction: 1 to 6 for x, y, z and rotations about them, negative against the axis,
/// 0 for a scalar.
struct UniversalDof {
  std::int64_t node;
  int direction;
};

/// A function of a universal file (dataset 58) with the values that the file has.
struct Function58 {
  std::size_t line = 0;  ///< of the file
  std::string why_not;   ///< what it is where it is no response to a force; the rest is empty then
  std::string name;      ///< first line of text
  UniversalDof output = {}, load = {};
  std::optional<ResponseQuantity> quantity = {};
  std::string unit_of_output, unit_of_load;  ///< words at the axes
  Eigen::VectorXd f_Hz;                      ///< [n_f] ascending
  Eigen::VectorXcd H;                        ///< [n_f]
};

constexpr int frequency_response = 4;  // function type

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

/// Reads a dataset 58, in ASCII or binary.
/// @throws chladni::Error naming file, line and record for a violation of the format.
/// Source: SDRC, Universal Dataset Number 58 (30 June 1999).
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

/// What a file says of responses and points.
struct FileOfFunctions {
  UniversalGeometry geometry;
  std::vector<Function58> functions;
  std::map<int, int> left_out;            ///< numbers of datasets, and how many of each
  std::map<std::string, int> unsuitable;  ///< why functions are none that can be compared
};

FileOfFunctions read_functions(const std::filesystem::path& path)
{
  FileOfFunctions contents;
  for (const UniversalDataset& dataset : read_universal_datasets(path)) {
    RecordReader records(path, dataset);
    if (dataset.number == 58) {
      auto function = read_function_58(records, dataset);
      if (function.why_not.empty())
        contents.functions.push_back(std::move(function));
      else
        ++contents.unsuitable[function.why_not];
    } else if (dataset.binary || !contents.geometry.take(records, dataset)) {
      ++contents.left_out[dataset.number];
    }
  }
  return contents;
}

std::vector<std::string> notes_on_functions(const std::string& file,
                                            const FileOfFunctions& contents)
{
  std::vector<std::string> notes;
  for (const auto& [why, n] : contents.unsuitable)
    notes.push_back(fmt::format("{}: left out: {} {} (dataset 58)", file, n, why));
  std::string numbers;
  for (const auto& [number, n] : contents.left_out)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number);
  if (!numbers.empty()) notes.push_back(fmt::format("{}: datasets not read: {}", file, numbers));
  if (!contents.geometry.units()) {
    const Function58& one = contents.functions.front();
    notes.push_back(fmt::format(
        "{}: no units (dataset 164), so that values are taken for SI; the first function "
        "has '{}' per '{}' at its axes",
        file, one.unit_of_output, one.unit_of_load));
  }
  return notes;
}

void require_same_frequencies(const std::string& file, const std::vector<Function58>& functions)
{
  const Function58& first = functions.front();
  for (const Function58& one : functions) {
    // Six digits of single precision.
    const bool is_same =
        one.f_Hz.size() == first.f_Hz.size() &&
        (one.f_Hz - first.f_Hz).cwiseAbs().maxCoeff() <= 1e-5 * first.f_Hz.cwiseAbs().maxCoeff();
    if (is_same) continue;
    throw Error(
        fmt::format("{}:{}: dataset 58: its {} frequencies are others than the {} of the function "
                    "in line {}; write functions of different frequencies into files of their own",
                    file, one.line, one.f_Hz.size(), first.f_Hz.size(), first.line));
  }
}

/// What turns values of the file into those of the SI. An angle has no unit of length.
double scale_of(const UniversalUnits& units, const MeasuredDof& output, const MeasuredDof& load)
{
  const double motion = output.component < 3 ? units.metres : 1.0;
  return motion / (load.component < 3 ? units.newtons : units.newtons * units.metres);
}

MeasuredFunction in_si(const Function58& one, const UniversalGeometry& geometry)
{
  MeasuredFunction function{.line = one.line,
                            .name = one.name,
                            .output = {one.output.node, std::abs(one.output.direction) - 1},
                            .load = {one.load.node, std::abs(one.load.direction) - 1},
                            .quantity = one.quantity,
                            .H = one.H};
  const double scale =
      geometry.units() ? scale_of(*geometry.units(), function.output, function.load) : 1.0;
  const bool is_reversed = (one.output.direction < 0) != (one.load.direction < 0);
  function.H *= is_reversed ? -scale : scale;
  return function;
}

std::map<std::int64_t, MeasuredPlace> places_of(const std::string& file,
                                                const FileOfFunctions& contents,
                                                std::optional<double> metres)
{
  std::map<std::int64_t, MeasuredPlace> places;
  const UniversalGeometry& geometry = contents.geometry;
  if (geometry.nodes().empty()) return places;
  if (geometry.units()) metres = geometry.units()->metres;
  if (!metres) {
    throw Error(fmt::format(
        "{}: has nodes and does not say their unit of length (dataset 164); give --length-unit",
        file));
  }
  std::set<std::int64_t> used;
  for (const Function58& one : contents.functions) used.insert({one.output.node, one.load.node});
  for (const std::int64_t number : used) {
    const auto found = geometry.nodes().find(number);
    if (found == geometry.nodes().end()) continue;
    places.emplace(number, MeasuredPlace{*metres * found->second.position,
                                         geometry.is_in_global_axes(found->second)});
  }
  return places;
}

}  // namespace

MeasuredFunctions read_measured_functions(const std::filesystem::path& path,
                                          std::optional<double> metres)
{
  const FileOfFunctions contents = read_functions(path);
  if (contents.functions.empty()) {
    std::string others;
    for (const auto& [why, n] : contents.unsuitable) others += fmt::format("; {} {}", n, why);
    throw Error(fmt::format(
        "{}: has no frequency response for a load at a node (dataset 58 of type 4){}; write the "
        "responses to forces with nodes and directions",
        path.string(), others));
  }
  require_same_frequencies(path.string(), contents.functions);
  MeasuredFunctions measured{.file = path.string(),
                             .f_Hz = contents.functions.front().f_Hz,
                             .functions = {},
                             .nodes = places_of(path.string(), contents, metres),
                             .notes = notes_on_functions(path.string(), contents)};
  for (const Function58& one : contents.functions)
    measured.functions.push_back(in_si(one, contents.geometry));
  return measured;
}

MeasuredFunctions within(const MeasuredFunctions& measured, double from_Hz, double to_Hz)
{
  const auto& f = measured.f_Hz;
  const auto first = std::ranges::lower_bound(f, from_Hz),
             last = std::ranges::upper_bound(f, to_Hz);
  const Index n = last - first;
  if (n < 2) {
    throw Error(fmt::format(
        "{}: has {} of its frequencies, {:.6g} to {:.6g} Hz, within the range of {:.6g} to {:.6g} "
        "Hz that [response] asks for (from_Hz, to_Hz); two or more are needed",
        measured.file, std::max<Index>(n, 0), f[0], f[f.size() - 1], from_Hz, to_Hz));
  }
  MeasuredFunctions part = measured;
  part.f_Hz = f.segment(first - f.begin(), n);
  part.functions.clear();
  for (const MeasuredFunction& one : measured.functions) {
    part.functions.push_back(one);
    part.functions.back().H = one.H.segment(first - f.begin(), n);
    if (one.H.segment(first - f.begin(), n).cwiseAbs().maxCoeff() > 0.0) continue;
    part.functions.pop_back();
    part.notes.push_back(
        fmt::format("{}:{}: left out: a function that is zero from {:.6g} to {:.6g} "
                    "Hz (dataset 58)",
                    measured.file, one.line, from_Hz, to_Hz));
  }
  if (part.functions.empty()) {
    throw Error(fmt::format("{}: all its functions are zero from {:.6g} to {:.6g} Hz",
                            measured.file, from_Hz, to_Hz));
  }
  return part;
}

}  // namespace chladni::mbs_export
