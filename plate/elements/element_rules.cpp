#include "plate/elements/element_rules.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace chladni::plate {

namespace {

using Eigen::Index;

Rules make_rules(mesh::Shape shape, int order)
{
  Rules rules;
  for (auto [rule, n] : {std::pair{&rules.full, order + 1}, {&rules.reduced, order}}) {
    rule->points = gauss_points(shape, n);
    rule->basis = lagrange_basis(shape, order, rule->points);
  }
  if (shape == mesh::Shape::triangle) rules.bubbles = basis_with_bubbles(order, rules.full.points);
  return rules;
}

}  // namespace

const Rules& rules_of(mesh::Shape shape, int order)
{
  static std::map<std::pair<mesh::Shape, int>, Rules> cache;
  const std::pair key{shape, order};
  const auto it = cache.find(key);
  return it != cache.end() ? it->second
                           : cache.emplace(key, make_rules(shape, order)).first->second;
}

double thickness_blend(mesh::Shape shape, int order, const ShellNodes& nodes, double c)
{
  const Index last = nodes.x.rows() - 1;
  const std::vector<Index> corners = shape == mesh::Shape::triangle
                                         ? std::vector<Index>{0, order, last}
                                         : std::vector<Index>{0, order, last, last - order};
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += (nodes.x.row(corners[i]) - nodes.x.row(corners[(i + 1) % corners.size()])).squaredNorm();
  const double thickness_squared = 4.0 * nodes.D.rowwise().squaredNorm().mean();
  return thickness_squared / (thickness_squared + c * 0.25 * sum);
}

double share_of_reduced_integration(int order, const ShellNodes& nodes)
{
  if (order != 2 && order != 3) return 0.0;
  const double c = order == 2 ? 0.5 : 0.1;
  return std::min(0.95, thickness_blend(mesh::Shape::quadrilateral, order, nodes, c));
}

}  // namespace chladni::plate
