#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "mbs_export/measured/universal_lines.hpp"

namespace chladni::mbs_export {

/// Columns of a line.
struct Columns {
  std::size_t first;  ///< from 0
  std::size_t width;
};

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
  /// The integers in some columns of the next line; 0 where these are blank.
  std::vector<std::int64_t> fields(const char* what, std::initializer_list<Columns> columns);
  /// The next `n` numbers of `width` columns each, `per_line` in each line; exponents with E or D.
  std::vector<double> reals(const char* what, std::size_t n, std::size_t width,
                            std::size_t per_line);
  /// The next line as numbers, which stand in as many words, or in these numbers of columns where
  /// no blanks part them.
  std::vector<double> line_of_reals(const char* what, const std::vector<std::size_t>& widths);
  /// Throws chladni::Error "FILE:LINE: dataset N: WHAT" for the line that was read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const std::filesystem::path& path_;
  const UniversalDataset& dataset_;
  std::size_t next_ = 0;
};

}  // namespace chladni::mbs_export
