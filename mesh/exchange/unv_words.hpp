#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/exchange/unv.hpp"

namespace chladni::mesh {

/// Reads the numbers of a dataset one by one, across lines. All functions throw chladni::Error
/// naming line and dataset.
class UnvWords {
 public:
  /// @param dataset  must outlive this object
  explicit UnvWords(const UnvDataset& dataset) : dataset_(dataset) {}

  bool at_end();
  /// The next whole line, trimmed.
  std::string line();
  /// @param what  name of the number, for errors
  std::int64_t integer(const char* what);
  /// An integer of at least 1.
  std::int64_t number(const char* what);
  double real(const char* what);
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  void next_line();
  void skip_blanks();
  std::string_view next(const char* what);

  const UnvDataset& dataset_;
  std::size_t line_ = 0, column_ = 0;
};

}  // namespace chladni::mesh
