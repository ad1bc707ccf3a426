#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::mesh {

/// The numbers from `from` up to `to`, each `step` behind the last; one number where both are the
/// same.
struct NumberRange {
  std::int64_t from, to, step;
};

/// One entry of a bulk data deck, its fields as texts.
class Card {
 public:
  Card(std::string name, int line) : name_(std::move(name)), line_(line) {}

  const std::string& name() const { return name_; }
  int line() const { return line_; }
  /// Fields behind the name, without those that mark continuations.
  std::size_t n_fields() const { return fields_.size(); }
  /// The i-th field from 1 on; empty where it is blank or not there.
  std::string_view field(std::size_t i) const;
  bool has(std::size_t i) const { return !field(i).empty(); }

  /// A number at least 0.
  /// @param what  of the card: "a node", "PID"
  /// @throws chladni::Error naming line, card and field of what is no such number.
  std::int64_t integer(std::size_t i, std::string_view what) const;
  std::int64_t integer_or(std::size_t i, std::string_view what, std::int64_t otherwise) const;
  double real(std::size_t i, std::string_view what) const;
  double real_or(std::size_t i, std::string_view what, double otherwise) const;
  std::array<double, 3> vector_or_zero(std::size_t first, std::string_view what) const;
  /// Digits of components, as 0 to 5, ascending.
  std::vector<int> components(std::size_t i) const;
  /// Numbers from a field on, with those of THRU (and BY) as one range.
  std::vector<NumberRange> ranges(std::size_t first, std::string_view what) const;

  /// @throws chladni::Error where a field from `first` to `last` is not blank.
  void expect_blank(std::size_t first, std::size_t last, std::string_view why) const;
  void expect_no_more_than(std::size_t n) const;
  [[noreturn]] void refuse(std::string_view why) const;

  void append(const std::vector<std::string>& fields, std::size_t width);

 private:
  std::string name_;
  int line_;
  std::vector<std::string> fields_;
};

/// The entries of a bulk data deck in small, large and free fields, with continuations that follow
/// their lines, from BEGIN BULK on if it stands there, up to ENDDATA.
/// @throws chladni::Error naming the line of what is no entry.
std::vector<Card> nastran_cards(const std::string& text);

}  // namespace chladni::mesh
