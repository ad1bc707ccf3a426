#include "read_results.hpp"

#include "report/describe_body.hpp"
#include "report/page/squeal_page.hpp"
#include "report/text_table.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::fuzz {

void read_results(const std::string& path)
{
  const squeal::SquealResults results = squeal::read_results(path);
  report::format_table(report::describe(results));
  report::Json::object(report::squeal_members(results, {})).text();
  report::squeal_motions(results, {1, 3}, 3);
}

void read_radiation(const std::string& path)
{
  const squeal::Radiation radiation = squeal::read_radiation(path);
  squeal::with_radiation({.rings = {},
                          .mode_numbers = {1, 3},
                          .omega = Eigen::Vector2d(1.0, 2.0) / 3.0,
                          .C = Eigen::Matrix2d::Zero(),
                          .G = Eigen::Matrix2d::Zero()},
                         radiation);
}

}  // namespace chladni::fuzz
