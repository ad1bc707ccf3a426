#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {

/// The numbers `from`, from + step, ... up to `to`. A single number has from = to.
struct NumberRange {
  std::int64_t from, to, step;
};

/// An entry of a bulk data deck with its fields as text.
class Card {
 public:
  /// @param place  "line 7"
  Card(std::string name, std::string place) : name_(std::move(name)), place_(std::move(place)) {}

  const std::string& name() const { return name_; }
  const std::string& place() const { return place_; }
  /// Number of fields after the name, without the fields that mark continuations.
  std::size_t n_fields() const { return fields_.size(); }
  /// Field i, counted from 1; empty if it is blank or missing.
  std::string_view field(std::size_t i) const;
  bool has(std::size_t i) const { return !field(i).empty(); }

  /// The value of field i as an integer that is not negative.
  /// @param what  name of the field for the message: "a node", "PID"
  /// @throws chladni::Error naming line, card and field when it is not such a number.
  std::int64_t integer(std::size_t i, std::string_view what) const;
  std::int64_t integer_or(std::size_t i, std::string_view what, std::int64_t otherwise) const;
  double real(std::size_t i, std::string_view what) const;
  double real_or(std::size_t i, std::string_view what, double otherwise) const;
  std::array<double, 3> vector_or_zero(std::size_t first, std::string_view what) const;
  /// The components of field i, such as "123", as 0 to 5, ascending.
  std::vector<int> components(std::size_t i) const;
  /// The numbers from the field `first` on; THRU (with BY) makes a range.
  std::vector<NumberRange> ranges(std::size_t first, std::string_view what) const;

  /// Checks that the fields `first` to `last` are blank.
  /// @throws chladni::Error with `why` when one is not.
  void expect_blank(std::size_t first, std::size_t last, std::string_view why) const;
  void expect_no_more_than(std::size_t n) const;
  [[noreturn]] void refuse(std::string_view why) const;

  void append(const std::vector<std::string>& fields, std::size_t width);
  /// Gives field i a value if it is blank.
  void fill(std::size_t i, std::string_view value);

 private:
  std::string name_;
  std::string place_;
  std::vector<std::string> fields_;
};

/// Reads the entries of a bulk data deck, in small, large and free fields, from BEGIN BULK (if
/// present) to ENDDATA. A continuation follows its entry, or the line that ends with its mark.
/// Blank fields of a GRID have the values of GRDSET. What case control chooses comes first: cards
/// CASE with the fields SPC or MPC and the number of the set, or without a number where a case
/// control chooses none. Its PARAM are cards too.
/// @throws chladni::Error naming a line that is no entry, or that cannot be included.
std::vector<Card> nastran_cards(const std::string& text,
                                const ReadIncluded& read = refuse_included);

}  // namespace chladni::mesh
