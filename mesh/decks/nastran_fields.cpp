#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.hpp"
#include "mesh/decks/nastran_cards.hpp"

namespace chladni::mesh {
namespace {

constexpr std::int64_t greatest_number = 2'147'483'647;

/// As C++ writes a number: Nastran leaves out the letter of an exponent, or writes D.
std::string with_exponent(std::string_view field)
{
  std::string text;
  for (const char c : field) {
    const bool is_sign = c == '+' || c == '-';
    if (is_sign && !text.empty() && text.back() != 'e') text += 'e';
    const bool is_exponent = c == 'D' || c == 'd' || c == 'E' || c == 'e';
    text += is_exponent ? 'e' : c;
  }
  if (text.starts_with('+')) text.erase(0, 1);
  const std::size_t plus = text.find("e+");
  if (plus != std::string::npos) text.erase(plus + 1, 1);
  return text;
}

}  // namespace

std::string_view Card::field(std::size_t i) const
{
  return i >= 1 && i <= fields_.size() ? std::string_view(fields_[i - 1]) : std::string_view();
}

void Card::refuse(std::string_view why) const
{
  throw Error(fmt::format("{}: {} {}: {}", place_, name_, field(1), why));
}

std::int64_t Card::integer(std::size_t i, std::string_view what) const
{
  const std::string_view text = field(i);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 0 &&
      value <= greatest_number)
    return value;
  refuse(fmt::format("\"{}\" in field {} is no {}; that is a number from 0 to {}", text, i + 1,
                     what, greatest_number));
}

std::int64_t Card::integer_or(std::size_t i, std::string_view what, std::int64_t otherwise) const
{
  return has(i) ? integer(i, what) : otherwise;
}

double Card::real(std::size_t i, std::string_view what) const
{
  const std::string text = with_exponent(field(i));
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value))
    return value;
  refuse(fmt::format("\"{}\" in field {} is no number, which {} is", field(i), i + 1, what));
}

double Card::real_or(std::size_t i, std::string_view what, double otherwise) const
{
  return has(i) ? real(i, what) : otherwise;
}

std::array<double, 3> Card::vector_or_zero(std::size_t first, std::string_view what) const
{
  return {real_or(first, what, 0.0), real_or(first + 1, what, 0.0), real_or(first + 2, what, 0.0)};
}

std::vector<int> Card::components(std::size_t i) const
{
  std::vector<int> found;
  for (const char c : field(i)) {
    if (c < '1' || c > '6')
      refuse(fmt::format("\"{}\" in field {} are no components of 1 to 6", field(i), i + 1));
    found.push_back(c - '1');
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<NumberRange> Card::ranges(std::size_t first, std::string_view what) const
{
  std::vector<NumberRange> ranges;
  for (std::size_t i = first; i <= n_fields(); ++i) {
    if (!has(i)) continue;
    if (field(i) != "THRU") {
      const std::int64_t number = integer(i, what);
      ranges.push_back({.from = number, .to = number, .step = 1});
      continue;
    }
    if (ranges.empty() || ranges.back().from != ranges.back().to)
      refuse("THRU has no number before it");
    NumberRange& range = ranges.back();
    range.to = integer(++i, what);
    if (field(i + 1) == "BY") {
      range.step = integer(i + 2, "step");
      i += 2;
    }
    if (range.step < 1 || range.to <= range.from) {
      refuse(
          fmt::format("{} THRU {} BY {} is no range of numbers", range.from, range.to, range.step));
    }
  }
  return ranges;
}

void Card::expect_blank(std::size_t first, std::size_t last, std::string_view why) const
{
  for (std::size_t i = first; i <= last; ++i)
    if (has(i)) refuse(fmt::format("\"{}\" in field {}: {}", field(i), i + 1, why));
}

void Card::expect_no_more_than(std::size_t n) const
{
  expect_blank(n + 1, std::max(n + 1, n_fields()), "nothing is known of this field");
}

void Card::fill(std::size_t i, std::string_view value)
{
  if (fields_.size() < i) fields_.resize(i);
  if (fields_[i - 1].empty()) fields_[i - 1] = value;
}

void Card::append(const std::vector<std::string>& fields, std::size_t width)
{
  while (fields_.size() % width != 0) fields_.emplace_back();
  fields_.insert(fields_.end(), fields.begin(), fields.end());
}

}  // namespace chladni::mesh
