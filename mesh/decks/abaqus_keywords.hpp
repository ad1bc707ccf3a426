#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {

/// A data line of a keyword, in capitals, split at its commas.
struct KeywordRow {
  std::string place;  ///< "line 7"
  std::vector<std::string> fields;
};

/// A keyword of an Abaqus input file with its parameters and data lines. All text is in capitals,
/// since case has no meaning there.
struct Keyword {
  std::string name;
  std::string place;  ///< "line 7"
  /// Values by name; empty for a parameter without a value.
  std::map<std::string, std::string> parameters;
  std::vector<KeywordRow> rows;

  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
  /// The value of a parameter.
  /// @throws chladni::Error naming line and keyword when it is missing.
  const std::string& parameter(const std::string& name) const;
  /// Checks that the keyword has no other parameters than these.
  /// @throws chladni::Error naming the first other one.
  void expect_only(const std::set<std::string>& known) const;
  /// Throws chladni::Error with line, keyword and `why`.
  [[noreturn]] void refuse(std::string_view why) const;
  [[noreturn]] void refuse(const KeywordRow& row, std::string_view why) const;

  /// Field i of a row, counted from 0; empty if the row is shorter.
  static std::string_view field(const KeywordRow& row, std::size_t i);
  bool is_integer(std::string_view text) const;
  std::int64_t integer(const KeywordRow& row, std::size_t i, std::string_view what) const;
  double real(const KeywordRow& row, std::size_t i, std::string_view what) const;
  double real_or(const KeywordRow& row, std::size_t i, std::string_view what,
                 double otherwise) const;
};

/// The keywords of an input file, without comments, as those of a flat model: parts stand where
/// their instances are (`flat_keywords`), and the supports and sets of the first step before it.
/// @throws chladni::Error naming a line that is neither a keyword nor its data, or that cannot be
///         included.
std::vector<Keyword> abaqus_keywords(const std::string& text,
                                     const ReadIncluded& read = refuse_included);

/// Puts the keywords of each part in the place of its instances, with their numbers and names:
/// "A-1.HELD" is the set HELD of the instance A-1, and the numbers of the second instance follow a
/// power of ten beyond all numbers, as those of the assembly follow the last one's. Of each
/// instance a keyword INSTANCE stays with NAME and OFFSET. Other keywords pass.
/// @throws chladni::Error naming an instance whose part is missing, and parts that do not end.
std::vector<Keyword> flat_keywords(std::vector<Keyword> keywords);

}  // namespace chladni::mesh
