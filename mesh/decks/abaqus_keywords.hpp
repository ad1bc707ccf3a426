#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::mesh {

/// A data line of a keyword, in capitals, cut at its commas.
struct KeywordRow {
  int line;
  std::vector<std::string> fields;
};

/// A keyword of an input file of Abaqus with its parameters and data lines, all in capitals, as
/// case means nothing there.
struct Keyword {
  std::string name;
  int line;
  std::map<std::string, std::string> parameters;  ///< without a value: empty
  std::vector<KeywordRow> rows;

  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
  /// @throws chladni::Error naming line and keyword where it is missing.
  const std::string& parameter(const std::string& name) const;
  /// @throws chladni::Error naming a parameter that is none of these.
  void expect_only(const std::set<std::string>& known) const;
  [[noreturn]] void refuse(std::string_view why) const;
  [[noreturn]] void refuse(const KeywordRow& row, std::string_view why) const;

  /// The i-th field of a row from 0 on; empty where it is not there.
  static std::string_view field(const KeywordRow& row, std::size_t i);
  bool is_integer(std::string_view text) const;
  std::int64_t integer(const KeywordRow& row, std::size_t i, std::string_view what) const;
  double real(const KeywordRow& row, std::size_t i, std::string_view what) const;
  double real_or(const KeywordRow& row, std::size_t i, std::string_view what,
                 double otherwise) const;
};

/// The keywords of an input file, without comments.
/// @throws chladni::Error naming the line of what is none.
std::vector<Keyword> abaqus_keywords(const std::string& text);

}  // namespace chladni::mesh
