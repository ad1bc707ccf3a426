#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
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

}  // namespace chladni::report
