#include "mbs_export/measured/universal_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "common/error.hpp"
#include "files/regular_file.hpp"

namespace chladni::mbs_export {
namespace {

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A field of columns as a number; nothing where it is none.
template <class Number>
std::optional<Number> number_of(std::string field)
{
  std::ranges::replace(field, 'D', 'E');
  std::ranges::replace(field, 'd', 'e');
  if (field.starts_with('+')) field.erase(0, 1);
  Number value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool is_delimiter(const std::string& line)
{
  return trimmed(line) == "-1" && line.size() <= 80;
}

[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line,
                          const std::string& what)
{
  throw Error(fmt::format("{}:{}: {}", path.string(), line, what));
}

/// The number in the second line of a dataset.
int dataset_number(const std::filesystem::path& path, std::size_t at, const std::string& line)
{
  if (line.size() > 6 && (line[6] == 'b' || line[6] == 'B')) {
    fail_at(path, at,
            "the dataset " + trimmed(line.substr(0, 6)) + " is binary; write the file in ASCII");
  }
  const auto number = number_of<int>(trimmed(line));
  if (!number || *number < 1) {
    fail_at(path, at,
            "expected the number of a dataset, found '" + trimmed(line).substr(0, 20) + "'");
  }
  return *number;
}

}  // namespace

std::vector<UniversalDataset> read_universal_datasets(const std::filesystem::path& path)
{
  files::regular_file_size(path.string());
  std::ifstream file(path);
  std::vector<UniversalDataset> datasets;
  bool is_inside = false, is_numbered = false;
  std::string line;
  std::size_t at = 0;
  while (std::getline(file, line)) {
    ++at;
    if (is_delimiter(line)) {
      if (is_inside && !is_numbered) fail_at(path, at, "a dataset without a number");
      is_inside = !is_inside;
      is_numbered = false;
    } else if (!is_inside && !trimmed(line).empty()) {
      fail_at(path, at, "expected a line of -1, which begins a dataset of a universal file");
    } else if (is_inside && !is_numbered) {
      datasets.push_back({dataset_number(path, at, line), at + 1, {}});
      is_numbered = true;
    } else if (is_inside) {
      datasets.back().lines.push_back(line);
    }
  }
  if (file.bad() || !file.eof()) throw Error(fmt::format("{}: cannot be read", path.string()));
  if (is_inside) fail_at(path, at, "the file ends within a dataset; a line of -1 is missing");
  return datasets;
}

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
    const std::string field =
        i * width < record.size() ? trimmed(record.substr(i * width, width)) : "";
    const auto value = number_of<std::int64_t>(field);
    if (!value) fail(fmt::format("{}: field {} is '{}', no whole number", what, i + 1, field));
    values.push_back(*value);
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
      const std::string field =
          i * width < record.size() ? trimmed(record.substr(i * width, width)) : "";
      const auto value = number_of<double>(field);
      if (!value || !std::isfinite(*value))
        fail(fmt::format("{}: field {} is '{}', no number", what, i + 1, field));
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

}  // namespace chladni::mbs_export
