#include "mbs_export/measured/record_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "mbs_export/measured/universal_fields.hpp"

namespace chladni::mbs_export {
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

}  // namespace chladni::mbs_export
