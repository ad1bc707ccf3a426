#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// A dataset of a universal file, between two lines of -1: records in fixed columns.
struct UniversalDataset {
  int number;
  std::size_t first_line;  ///< line number in the file of the first of `lines`, from 1
  std::vector<std::string> lines;
};

/// The datasets of a file, in their order.
/// @throws chladni::Error naming the file and the line when it is no universal file, a dataset is
///         binary, or the file ends within one.
std::vector<UniversalDataset> read_universal_datasets(const std::filesystem::path& path);

/// Reads a dataset line by line. Errors name file, line and dataset.
class RecordReader {
 public:
  RecordReader(const std::filesystem::path& path, const UniversalDataset& dataset)
      : path_(path), dataset_(dataset)
  {}

  bool at_end() const { return next_ == dataset_.lines.size(); }
  /// The next line.
  /// @param what  name of the record, for errors
  const std::string& line(const char* what);
  /// The next line as `n` integers of `width` columns each.
  std::vector<std::int64_t> integers(const char* what, std::size_t n, std::size_t width = 10);
  /// The next `n` numbers of `width` columns each, `per_line` in each line; exponents with E or D.
  std::vector<double> reals(const char* what, std::size_t n, std::size_t width,
                            std::size_t per_line);
  /// Throws chladni::Error "FILE:LINE: dataset N: WHAT" for the line that was read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const std::filesystem::path& path_;
  const UniversalDataset& dataset_;
  std::size_t next_ = 0;
};

}  // namespace chladni::mbs_export
