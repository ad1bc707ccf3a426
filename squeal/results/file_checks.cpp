#include "squeal/results/file_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "mbs_export/files/body_files.hpp"

namespace chladni::squeal {

std::vector<int> read_mode_numbers(const files::Reader& file, const std::string& name)
{
  constexpr Eigen::Index limit = std::numeric_limits<int>::max();
  const std::vector<int> numbers = mbs_export::file_parts::read_indices(file, name, limit);
  std::set<int> seen;
  for (const int number : numbers) {
    if (number == 0) file.fail(name, "names mode 0, expected numbers from 1");
    if (!seen.insert(number).second) file.fail(name, fmt::format("names mode {} twice", number));
  }
  return numbers;
}

std::vector<double> read_times(const files::Reader& file, const std::string& name,
                               Eigen::Index size)
{
  const Eigen::VectorXd t = file.vector(name, size);
  if (!std::ranges::is_sorted(t)) file.fail(name, "expected times in ascending order");
  return {t.begin(), t.end()};
}

Eigen::VectorXd read_some(const files::Reader& file, const std::string& name)
{
  const Eigen::VectorXd values = file.vector(name);
  if (values.size() == 0) file.fail(name, "is empty, expected one value at least");
  return values;
}

}  // namespace chladni::squeal
