#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/exchange/unv.hpp"

namespace chladni::mesh {

/// The numbers of a dataset, one after the other, whatever lines they stand in. Functions throw
/// chladni::Error naming line and dataset.
class UnvWords {
 public:
  /// @param dataset  which must outlive the words
  explicit UnvWords(const UnvDataset& dataset) : dataset_(dataset) {}

  bool at_end();
  /// The next line as it is, from its begin on, trimmed.
  std::string line();
  /// @param what  the number is, for errors
  std::int64_t integer(const char* what);
  /// A number from 1 on.
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
