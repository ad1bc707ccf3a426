#include "mbs_export/measured/universal_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "common/error.hpp"
#include "files/regular_file.hpp"
#include "mbs_export/measured/universal_fields.hpp"

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

}  // namespace chladni::mbs_export
