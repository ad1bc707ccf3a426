#include "squeal/results/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace chladni::squeal {

std::size_t SweepTable::count(VariantState state) const
{
  return static_cast<std::size_t>(std::ranges::count(states, state));
}

SweepTable empty_sweep(std::vector<std::string> keys, files::RowMajorMatrix values,
                       std::vector<SweepColumn> columns)
{
  const Eigen::Index n = values.rows(), m = std::ssize(columns);
  return {.keys = std::move(keys),
          .values = std::move(values),
          .columns = std::move(columns),
          .results = files::RowMajorMatrix::Zero(n, m),
          .known = files::IntegerMatrix::Zero(n, m),
          .states = std::vector<VariantState>(static_cast<std::size_t>(n), VariantState::to_do),
          .failures = std::vector<std::string>(static_cast<std::size_t>(n)),
          .inputs = {}};
}

std::string name_of_variant(const SweepTable& sweep, std::size_t i)
{
  std::string name;
  for (std::size_t k = 0; k < sweep.keys.size(); ++k) {
    const double value = sweep.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    name += fmt::format("{}{} = {}", k == 0 ? "" : ", ", sweep.keys[k], value);
  }
  return name;
}

}  // namespace chladni::squeal
