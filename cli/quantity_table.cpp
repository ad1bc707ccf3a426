#include "cli/quantity_table.hpp"

#include <fmt/format.h>

namespace chladni::cli {

TextTable quantities()
{
  return {.header = {"quantity", "value", "unit"}, .rows = {}};
}

void add_count(TextTable& table, const std::string& name, Eigen::Index n)
{
  table.rows.push_back({name, fmt::format("{}", n), ""});
}

void add(TextTable& table, const std::string& name, double x, const std::string& unit)
{
  table.rows.push_back({name, fmt::format("{:.6g}", x), unit});
}

}  // namespace chladni::cli
