#include "report/page/numbers.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace chladni::report {

Json rounded(double x)
{
  return Json(std::strtod(fmt::format("{:.6g}", x).c_str(), nullptr));
}

Json rounded(std::span<const double> x)
{
  std::vector<Json> numbers;
  for (const double number : x) numbers.push_back(rounded(number));
  return Json::array(numbers);
}

Json rounded(const Eigen::VectorXd& x)
{
  return rounded(std::span(x.data(), static_cast<std::size_t>(x.size())));
}

Json rounded_rows(const Eigen::MatrixXd& rows)
{
  std::vector<Json> lists;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    lists.push_back(rounded(Eigen::VectorXd(rows.row(i))));
  return Json::array(lists);
}

Json table_json(const std::string& title, const TextTable& table)
{
  std::vector<Json> rows;
  for (const auto& row : table.rows) rows.push_back(texts(row));
  return Json::object(
      {{"title", title}, {"header", texts(table.header)}, {"rows", Json::array(rows)}});
}

Json texts(const std::vector<std::string>& words)
{
  return Json::array({words.begin(), words.end()});
}

}  // namespace chladni::report
