#include "mbs_export/measured/universal_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "common/error.hpp"
#include "common/files/input_file.hpp"

namespace chladni::mbs_export {

namespace {

bool is_delimiter(const std::string& line)
{
  return trimmed(line) == "-1" && line.size() <= 80;
}

/// Whether a line has nothing but numbers, as those of datasets. Words of people stand between
/// datasets too.
bool is_of_numbers(const std::string& line)
{
  return line.find_first_not_of("0123456789+-.eEdD \t\r") == std::string::npos &&
         line.find_first_of("0123456789") != std::string::npos;
}

/// The number in the second line of a dataset.
int dataset_number(const std::filesystem::path& path, std::size_t at, const std::string& line)
{
  const auto number = integer_in(trimmed(line));
  if (!number || *number < 1 || *number > 999999) {
    fail_at(path, at,
            "expected the number of a dataset, found '" + trimmed(line).substr(0, 20) + "'");
  }
  return static_cast<int>(*number);
}

/// What the second line of a binary dataset says: I6, A1, 2I6, 2I12.
struct BinaryHead {
  int number;
  bool is_little_endian;
  std::int64_t n_lines, n_bytes;
};

bool is_binary(const std::string& line)
{
  return line.size() > 6 && (line[6] == 'b' || line[6] == 'B');
}

BinaryHead read_binary_head(const std::filesystem::path& path, std::size_t at,
                            const std::string& line)
{
  const auto order = integer_in(field_of(line, 7, 6)), format = integer_in(field_of(line, 13, 6));
  const auto n_lines = integer_in(field_of(line, 19, 12)),
             n_bytes = integer_in(field_of(line, 31, 12));
  if (!order || !format || !n_lines || !n_bytes || (*order != 1 && *order != 2) || *n_lines < 0 ||
      *n_bytes < 0) {
    fail_at(path, at,
            "expected the head of a binary dataset: number, b, order of bytes (1 or 2), format of "
            "numbers, lines and bytes that follow; write the file in ASCII");
  }
  if (*format != 2) {
    fail_at(path, at,
            fmt::format("the format of the binary numbers is {}, and only 2 (IEEE 754) is read; "
                        "write the file in ASCII",
                        *format));
  }
  return {dataset_number(path, at, line.substr(0, 6)), *order == 1, *n_lines, *n_bytes};
}

/// The bytes of the values that record 7 of a dataset 58 announces: type, number, spacing.
std::optional<std::int64_t> bytes_by_record_7(const UniversalDataset& dataset)
{
  if (dataset.number != 58 || dataset.lines.size() < 7) return std::nullopt;
  const std::string& record = dataset.lines[6];
  const auto type = integer_in(field_of(record, 0, 10)), n = integer_in(field_of(record, 10, 10)),
             spacing = integer_in(field_of(record, 20, 10));
  constexpr std::int64_t most = 1'000'000'000;
  if (!type || !n || !spacing || *n < 0 || *n > most) return std::nullopt;
  const int precision = *type == 2 || *type == 5 ? 4 : 8,
            per_line = (*type >= 5 ? 2 : 1) + (*spacing == 0 ? 1 : 0);
  return precision * per_line * *n;
}

/// Whether a dataset ends at a place of a file.
bool ends_at(std::ifstream& file, std::streamoff place)
{
  file.clear();
  file.seekg(place);
  std::string line;
  for (int blank = 0; blank < 2 && std::getline(file, line); ++blank)
    if (!trimmed(line).empty()) return is_delimiter(line);
  return false;
}

/// The bytes after the lines of a dataset. Where their announced number is wrong, as pyuff 2.5
/// writes half of it for complex values, record 7 tells it.
std::string read_bytes(std::ifstream& file, const std::filesystem::path& path, std::size_t at,
                       const UniversalDataset& dataset, std::int64_t announced)
{
  const std::streamoff start = file.tellg();
  file.seekg(0, std::ios::end);
  const std::streamoff end = file.tellg();
  for (const auto& n : {std::optional(announced), bytes_by_record_7(dataset)}) {
    if (!n || start < 0 || *n > end - start || !ends_at(file, start + *n)) continue;
    std::string bytes(static_cast<std::size_t>(*n), '\0');
    file.clear();
    file.seekg(start);
    file.read(bytes.data(), *n);
    return bytes;
  }
  fail_at(
      path, at,
      fmt::format("dataset {}b: no line of -1 follows the {} bytes that it announces; write the "
                  "file again, or in ASCII",
                  dataset.number, announced));
}

/// Reads a file from dataset to dataset.
class DatasetReader {
 public:
  explicit DatasetReader(const std::filesystem::path& path) : path_(path), file_(path) {}

  std::vector<UniversalDataset> all()
  {
    std::vector<UniversalDataset> datasets;
    while (next_line())
      if (is_delimiter(line_))
        datasets.push_back(read_dataset());
      else if (is_of_numbers(line_))
        fail_at(path_, at_, "expected a line of -1, which begins a dataset of a universal file");
    if (datasets.empty()) fail_at(path_, 1, "is no universal file: no line of -1 begins a dataset");
    if (file_.bad() || !file_.eof()) throw Error(fmt::format("{}: cannot be read", path_.string()));
    return datasets;
  }

 private:
  bool next_line()
  {
    if (!std::getline(file_, line_)) return false;
    ++at_;
    return true;
  }

  void require_line()
  {
    if (!next_line())
      fail_at(path_, at_, "the file ends within a dataset; a line of -1 is missing");
  }

  /// All after its first line of -1, with the last one.
  UniversalDataset read_dataset()
  {
    require_line();
    if (is_delimiter(line_)) fail_at(path_, at_, "a dataset without a number");
    if (is_binary(line_)) return read_binary(read_binary_head(path_, at_, line_));
    UniversalDataset dataset{dataset_number(path_, at_, line_), at_ + 1, {}};
    for (require_line(); !is_delimiter(line_); require_line()) dataset.lines.push_back(line_);
    return dataset;
  }

  UniversalDataset read_binary(const BinaryHead& head)
  {
    UniversalDataset dataset{head.number, at_ + 1, {}};
    for (std::int64_t i = 0; i < head.n_lines; ++i) {
      require_line();
      dataset.lines.push_back(line_);
    }
    std::string bytes = read_bytes(file_, path_, at_, dataset, head.n_bytes);
    at_ += static_cast<std::size_t>(std::ranges::count(bytes, '\n'));
    dataset.binary = UniversalBytes{head.is_little_endian, std::move(bytes)};
    do require_line();
    while (!is_delimiter(line_));
    return dataset;
  }

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::string line_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<UniversalDataset> read_universal_datasets(const std::filesystem::path& path)
{
  files::regular_file_size(path.string());
  return DatasetReader(path).all();
}

namespace {

/// The words of a line, where they are so many numbers.
std::optional<std::vector<double>> words_as_reals(const std::string& record, std::size_t n)
{
  std::istringstream words(record);
  std::vector<double> values;
  for (std::string word; words >> word;) {
    const auto value = real_in(word);
    if (!value || values.size() == n) return std::nullopt;
    values.push_back(*value);
  }
  if (values.size() != n) return std::nullopt;
  return values;
}

}  // namespace

const std::string& RecordReader::line(const char* what)
{
  if (at_end()) {
    ++next_;
    fail(fmt::format("ends where {} is expected", what));
  }
  return dataset_.lines[next_++];
}

std::vector<std::int64_t> RecordReader::integers(const char* what, std::size_t n, std::size_t width)
{
  const std::string& record = line(what);
  std::vector<std::int64_t> values;
  for (std::size_t i = 0; i < n; ++i) {
    const std::string field = field_of(record, i * width, width);
    const auto value = integer_in(field);
    if (!value) fail(fmt::format("{}: field {} is '{}', no whole number", what, i + 1, field));
    values.push_back(*value);
  }
  return values;
}

std::vector<std::int64_t> RecordReader::fields(const char* what,
                                               std::initializer_list<Columns> columns)
{
  const std::string& record = line(what);
  std::vector<std::int64_t> values;
  for (const auto& [first, width] : columns) {
    const std::string field = field_of(record, first, width);
    const auto value = field.empty() ? std::int64_t{0} : integer_in(field);
    if (!value) {
      fail(fmt::format("{}: columns {} to {} are '{}', no whole number", what, first + 1,
                       first + width, field));
    }
    values.push_back(*value);
  }
  return values;
}

std::vector<double> RecordReader::line_of_reals(const char* what,
                                                const std::vector<std::size_t>& widths)
{
  const std::string& record = line(what);
  if (auto values = words_as_reals(record, widths.size())) return std::move(*values);
  std::vector<double> values;
  std::size_t first = 0;
  for (const std::size_t width : widths) {
    const auto value = real_in(field_of(record, first, width));
    if (!value) {
      fail(fmt::format("{}: columns {} to {} are '{}', no number", what, first + 1, first + width,
                       field_of(record, first, width)));
    }
    values.push_back(*value);
    first += width;
  }
  return values;
}

std::vector<double> RecordReader::reals(const char* what, std::size_t n, std::size_t width,
                                        std::size_t per_line)
{
  std::vector<double> values;
  while (values.size() < n) {
    const std::string& record = line(what);
    const std::size_t here = std::min(per_line, n - values.size());
    for (std::size_t i = 0; i < here; ++i) {
      const std::string field = field_of(record, i * width, width);
      const auto value = real_in(field);
      if (!value) fail(fmt::format("{}: field {} is '{}', no number", what, i + 1, field));
      values.push_back(*value);
    }
  }
  return values;
}

void RecordReader::fail(const std::string& what) const
{
  fail_at(path_, dataset_.first_line + next_ - 1,
          fmt::format("dataset {}: {}", dataset_.number, what));
}

namespace {

/// Record 2 of dataset 164 has what divides lengths, forces and temperatures of the file.
UniversalUnits read_units(RecordReader& records)
{
  records.line("units");
  const std::vector<double> per_si =
      records.reals("factors of length, force and temperature", 3, 25, 3);
  if (!(per_si[0] > 0.0)) records.fail("the factor of lengths is not positive");
  if (!(per_si[1] > 0.0)) records.fail("the factor of forces is not positive");
  return {1.0 / per_si[0], 1.0 / per_si[1]};
}

}  // namespace

bool UniversalGeometry::take(RecordReader& records, const UniversalDataset& dataset)
{
  switch (dataset.number) {
    case 15:
      read_nodes_15(records, dataset);
      return true;
    case 2411:
      read_nodes_2411(records);
      return true;
    case 164:
      units_ = read_units(records);
      return true;
    case 18:
      has_systems_18_ = true;
      return true;
    case 2420:
      has_systems_2420_ = true;
      return true;
    default:
      return false;
  }
}

bool UniversalGeometry::is_in_global_axes(const UniversalNode& node) const
{
  const auto is_global = [&](std::int64_t system) {
    return system == 0 || (system == 1 && !has_systems_18_);
  };
  const bool has_systems = has_systems_18_ || has_systems_2420_;
  return !has_systems || (is_global(node.defined_in) && is_global(node.displaced_in));
}

void UniversalGeometry::add(RecordReader& records, const std::vector<std::int64_t>& label,
                            const std::vector<double>& x)
{
  const UniversalNode node{{x[0], x[1], x[2]}, label[1], label[2]};
  if (!nodes_.emplace(label[0], node).second)
    records.fail(fmt::format("node {} is there twice", label[0]));
}

/// A line for each node, 4I10, 3E13.5.
void UniversalGeometry::read_nodes_15(RecordReader& records, const UniversalDataset& dataset)
{
  constexpr std::size_t columns = 40;
  for (const std::string& line : dataset.lines) {
    const std::vector<std::int64_t> label = records.integers("a node", 4);
    UniversalDataset place{dataset.number, dataset.first_line, {}};
    place.lines.push_back(line.size() > columns ? line.substr(columns) : "");
    const std::filesystem::path nowhere;
    RecordReader coordinates(nowhere, place);
    try {
      add(records, label, coordinates.reals("coordinates", 3, 13, 3));
    } catch (const Error&) {
      records.fail(
          "expected four whole numbers of 10 columns and three coordinates of 13, of a node "
          "that is there once");
    }
  }
}

/// Two lines for each node, 4I10 and 3D25.16.
void UniversalGeometry::read_nodes_2411(RecordReader& records)
{
  while (!records.at_end()) {
    const std::vector<std::int64_t> label = records.integers("a node", 4);
    add(records, label, records.reals("coordinates", 3, 25, 3));
  }
}

namespace {

template <class Number>
std::optional<Number> number_in(std::string field)
{
  std::ranges::replace(field, 'D', 'E');
  std::ranges::replace(field, 'd', 'e');
  if (field.starts_with('+')) field.erase(0, 1);
  Number value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string field_of(const std::string& line, std::size_t first, std::size_t width)
{
  return first < line.size() ? trimmed(line.substr(first, width)) : "";
}

std::optional<std::int64_t> integer_in(const std::string& field)
{
  return number_in<std::int64_t>(field);
}

std::optional<double> real_in(const std::string& field)
{
  const auto value = number_in<double>(field);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

void fail_at(const std::filesystem::path& path, std::size_t line, const std::string& what)
{
  throw Error(fmt::format("{}:{}: {}", path.string(), line, what));
}

}  // namespace chladni::mbs_export
