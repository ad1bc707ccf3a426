#pragma once

#include <Eigen/Core>
#include <string>

#include "cli/output.hpp"

/// Tables of quantities with their values and units.
namespace chladni::cli {

TextTable quantities();
void add_count(TextTable& table, const std::string& name, Eigen::Index n);
void add(TextTable& table, const std::string& name, double x, const std::string& unit);

}  // namespace chladni::cli
