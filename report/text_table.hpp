#pragma once

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::report {

/// The text with `?` for each control character (C0, DEL and C1) except newlines. Titles and names
/// come from files and must not control a terminal.
std::string printable(std::string_view text);

/// The message of an error for the terminal. For std::bad_alloc, whose own message is the name of a
/// type, it is a sentence.
std::string said(const std::exception& error);

/// A table for the terminal; every row has as many cells as the header.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// The table as text that ends with a newline: columns two blanks apart, the first aligned left,
/// the others right. When a line would be longer than 120 characters, the cells of the widest
/// column take several lines, indented after the first.
std::string format_table(const TextTable& table);

/// Flushes stdout.
/// @throws chladni::Error when not all output could be written.
void finish_printing();

/// Creates the output folder if needed.
/// @throws chladni::Error when it cannot be created.
void make_folder(const std::filesystem::path& folder);

}  // namespace chladni::report

/// Tables of quantities: name, value, unit.

namespace chladni::report {

/// An empty table with its header.
inline TextTable quantities()
{
  return {.header = {"quantity", "value", "unit"}, .rows = {}};
}

/// Adds a row with an integer.
inline void add_count(TextTable& table, const std::string& name, Eigen::Index n)
{
  table.rows.push_back({name, fmt::format("{}", n), ""});
}

/// Adds a row with a number in six digits and its unit.
inline void add(TextTable& table, const std::string& name, double x, const std::string& unit)
{
  table.rows.push_back({name, fmt::format("{:.6g}", x), unit});
}

/// A number of up to six digits that ends where its error does, and the error: "1.7188 +- 0.0021".
inline std::string with_error(double x, double error)
{
  constexpr int most_digits = 6;
  const auto place = [](double y) { return static_cast<int>(std::floor(std::log10(std::abs(y)))); };
  const bool is_plain = x != 0.0 && std::abs(x) < 1e6 && error > 1e-6 && error < 9.5;
  if (!is_plain) return fmt::format("{:.6g} +- {:.2g}", x, error);
  const int decimals = std::clamp(std::min(1 - place(error), most_digits - 1 - place(x)), 0, 9);
  return fmt::format("{:.{}f} +- {:#.2g}", x, decimals, error);
}

}  // namespace chladni::report
