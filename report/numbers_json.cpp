#include "report/numbers_json.hpp"

#include <numbers>
#include <vector>

namespace chladni::report {

Json numbers_json(const Eigen::VectorXd& values)
{
  std::vector<Json> numbers;
  for (const double value : values) numbers.emplace_back(value);
  return Json::array(numbers);
}

Json optional_json(const std::optional<double>& x)
{
  return x ? Json(*x) : Json();
}

Json frequencies_json(const Eigen::VectorXd& omega)
{
  return numbers_json(omega / (2.0 * std::numbers::pi));
}

}  // namespace chladni::report
