#pragma once

#include <cctype>
#include <string>
#include <vector>

namespace chladni {

/// True if a number without point or exponent, and not part of a name, ends before the comma.
inline bool is_whole_before(const std::string& formula, std::size_t comma)
{
  std::size_t begin = comma;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(formula[begin - 1])) != 0) --begin;
  if (begin == comma) return false;
  const char c = begin > 0 ? formula[begin - 1] : ' ';
  return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_';
}

/// True if digits without a point after them follow the comma.
inline bool is_whole_after(const std::string& formula, std::size_t comma)
{
  std::size_t end = comma + 1;
  while (end < formula.size() && std::isdigit(static_cast<unsigned char>(formula[end])) != 0) ++end;
  return end > comma + 1 && (end == formula.size() || formula[end] != '.');
}

/// Finds probable decimal commas in a formula, which a parser would misread: a comma that does not
/// separate arguments of a function, a comma without a blank between two integers, and an integer
/// that begins with 0.
/// @return what is wrong and how to write it; empty if nothing is
inline std::string decimal_comma_in(const std::string& formula)
{
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_';
  };
  std::vector<bool> is_call;
  char last = '\0';  // but for blanks
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const char c = formula[i], before = i > 0 ? formula[i - 1] : ' ',
               after = i + 1 < formula.size() ? formula[i + 1] : ' ';
    if (c == '(') is_call.push_back(std::isalnum(static_cast<unsigned char>(last)) != 0);
    if (c == ')' && !is_call.empty()) is_call.pop_back();
    if (c == ',' && (is_call.empty() || !is_call.back()))
      return "the comma does not part a function's arguments; write a decimal point, as in 0.02";
    if (c == ',' && is_whole_before(formula, i) && is_whole_after(formula, i)) {
      return "the comma between two digits may be a decimal one; write a decimal point, as in "
             "0.02, or a blank after the comma, as in max(1, 2)";
    }
    const bool is_exponent = i > 2 && (before == '-' || before == '+') &&
                             (formula[i - 2] == 'e' || formula[i - 2] == 'E') &&
                             (is_digit(formula[i - 3]) || formula[i - 3] == '.');
    if (c == '0' && !is_word(before) && !is_exponent && is_digit(after))
      return "a number begins with 0, as behind a decimal comma; write a decimal point, as in 0.02";
    if (c != ' ') last = c;
  }
  return {};
}

}  // namespace chladni
