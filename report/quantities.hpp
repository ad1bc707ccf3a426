#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>

#include "report/output.hpp"

/// Rows of a table of quantities.
namespace chladni::report {

/// An empty table with its header.
inline TextTable quantities()
{
  return {.header = {"quantity", "value", "unit"}, .rows = {}};
}

inline void add_count(TextTable& table, const std::string& name, Eigen::Index n)
{
  table.rows.push_back({name, fmt::format("{}", n), ""});
}

inline void add(TextTable& table, const std::string& name, double x, const std::string& unit)
{
  table.rows.push_back({name, fmt::format("{:.6g}", x), unit});
}

}  // namespace chladni::report
