#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "report/output.hpp"

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
