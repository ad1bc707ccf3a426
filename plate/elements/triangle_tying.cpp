#include <Eigen/Dense>
#include <map>
#include <vector>

#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/rotation_bubbles.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using PointList = std::vector<std::pair<double, double>>;

Points points_of(const PointList& list)
{
  const auto n = static_cast<Eigen::Index>(list.size());
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    points.xi[i] = list[i].first;
    points.eta[i] = list[i].second;
  }
  return points;
}

/// p Gauss points on each edge: s = 0, r = 0, r + s = 1.
Points edge_points(int p)
{
  const VectorXd gauss = (gauss_legendre(p).x.array() + 1.0) / 2.0;
  PointList list;
  for (const double g : gauss) list.emplace_back(g, 0.0);
  for (const double g : gauss) list.emplace_back(0.0, g);
  for (const double g : gauss) list.emplace_back(g, 1.0 - g);
  return points_of(list);
}

/// Two components at points, of shear strains or of a basis.
struct Components {
  MatrixXd first, second;
};

/// The Nedelec basis of the first kind, order p: P_(p-1)^2 + (s, -r) times the homogeneous
/// polynomials of degree p-1. [n_points x p (p + 2)]
Components nedelec_basis(int p, const Points& points)
{
  const MatrixXd P = monomials(p - 1, points);
  const MatrixXd top = P.rightCols(p);
  const MatrixXd zero = MatrixXd::Zero(P.rows(), P.cols());
  Components basis{.first = MatrixXd(P.rows(), 2 * P.cols() + p),
                   .second = MatrixXd(P.rows(), 2 * P.cols() + p)};
  basis.first << P, zero, points.eta.asDiagonal() * top;
  basis.second << zero, P, -(points.xi.asDiagonal() * top);
  return basis;
}

/// The degrees of freedom of the Nedelec space: the tangential component at the p Gauss points of
/// each edge, and `inner` applied to each component at inner points.
MatrixXd nedelec_values(int p, const Components& on_edges, const MatrixXd& inner,
                        const Components& inside)
{
  MatrixXd values(3 * p + 2 * inner.rows(), inside.first.cols());
  values << on_edges.first.topRows(p), on_edges.second.middleRows(p, p),
      on_edges.first.bottomRows(p) - on_edges.second.bottomRows(p), inner * inside.first,
      inner * inside.second;
  return values;
}

/// Shear at the integration points = weights times the values of `nedelec_values`.
struct ShearTying {
  BubbleBasis edges, inside;  ///< at the points of `nedelec_values`
  MatrixXd inner;             ///< [n x n_inner_points]
  Components weights;
};

/// Inner conditions: the mean at order 2, the values at three points at order 3. Means at order 3
/// make a thick plate stiffer, values at order 2 a thin one softer than it is.
ShearTying make_shear_tying(int order)
{
  constexpr double near = 1.0 / 6.0, far = 4.0 / 6.0;
  const Points integration = gauss_points(mesh::Shape::triangle, order + 1);
  const Points inside =
      order == 2 ? integration : points_of({{near, near}, {far, near}, {near, far}});
  const MatrixXd inner =
      order == 2 ? MatrixXd(integration.weight.transpose()) : MatrixXd(MatrixXd::Identity(3, 3));
  const MatrixXd inverse = nedelec_values(order, nedelec_basis(order, edge_points(order)), inner,
                                          nedelec_basis(order, inside))
                               .inverse();
  const Components at_gauss = nedelec_basis(order, integration);
  return {.edges = basis_with_bubbles(order, edge_points(order)),
          .inside = basis_with_bubbles(order, inside),
          .inner = inner,
          .weights = {.first = at_gauss.first * inverse, .second = at_gauss.second * inverse}};
}

/// Membrane strains at the integration points = weights times the values of `regge_values`.
struct MembraneTying {
  BubbleBasis edges;  ///< at their Gauss points
  MatrixXd moments;   ///< [n x n_integration_points] against the polynomials of degree p-2
  std::array<MatrixXd, 3> weights;
};

/// Strain along each edge at its p Gauss points, then the moments of the three components.
MatrixXd regge_values(int p, const std::array<MatrixXd, 3>& on_edges,
                      const std::array<MatrixXd, 3>& moments)
{
  const auto& [e_11, e_22, e_12] = on_edges;
  const Eigen::Index n = moments[0].rows();
  MatrixXd values(3 * p + 3 * n, e_11.cols());
  values << e_11.topRows(p), e_22.middleRows(p, p),
      e_11.bottomRows(p) + e_22.bottomRows(p) - 2.0 * e_12.bottomRows(p), moments[0], moments[1],
      moments[2];
  return values;
}

/// P for one component, zero for the two others.
std::array<MatrixXd, 3> three_components(const MatrixXd& P)
{
  const MatrixXd zero = MatrixXd::Zero(P.rows(), P.cols());
  std::array<MatrixXd, 3> components;
  for (MatrixXd& component : components) component.resize(P.rows(), 3 * P.cols());
  components[0] << P, zero, zero;
  components[1] << zero, P, zero;
  components[2] << zero, zero, P;
  return components;
}

MembraneTying make_membrane_tying(int p)
{
  const Points integration = gauss_points(mesh::Shape::triangle, p + 1);
  const Points edges = edge_points(p);
  const MatrixXd moments =
      monomials(p - 2, integration).transpose() * integration.weight.asDiagonal();
  const MatrixXd P = monomials(p - 1, integration);
  const MatrixXd inverse =
      regge_values(p, three_components(monomials(p - 1, edges)), three_components(moments * P))
          .inverse();
  MembraneTying tying{.edges = basis_with_bubbles(p, edges), .moments = moments, .weights = {}};
  for (std::size_t r = 0; r < 3; ++r) tying.weights[r] = three_components(P)[r] * inverse;
  return tying;
}

/// `make(order)`, made once for each order.
template <typename TyingOf>
const auto& made_once(int order, TyingOf make)
{
  static std::map<int, decltype(make(order))> cache;
  const auto it = cache.find(order);
  return it != cache.end() ? it->second : cache.emplace(order, make(order)).first->second;
}

}  // namespace

CovariantStrains assume_triangle_shear(int order, const ShellNodes& nodes,
                                       const CovariantStrains& compatible)
{
  const ShearTying& tying = made_once(order, make_shear_tying);
  const CovariantStrains on_edges = strains_with_bubbles(tying.edges, nodes, StrainParts::shear);
  const CovariantStrains inside = strains_with_bubbles(tying.inside, nodes, StrainParts::shear);
  const auto interpolate = [&](const auto& edge_values, const auto& inner_values) {
    const MatrixXd dofs = nedelec_values(order, {edge_values[0], edge_values[1]}, tying.inner,
                                         {inner_values[0], inner_values[1]});
    return std::array<StrainRows, 2>{tying.weights.first * dofs, tying.weights.second * dofs};
  };
  CovariantStrains assumed = compatible;
  assumed.g0 = interpolate(on_edges.g0, inside.g0);
  assumed.g1 = interpolate(on_edges.g1, inside.g1);
  return assumed;
}

CovariantStrains assume_triangle_membrane(int order, const ShellNodes& nodes,
                                          const CovariantStrains& compatible)
{
  const MembraneTying& tying = made_once(order, make_membrane_tying);
  const CovariantStrains tied = strains_with_bubbles(tying.edges, nodes, StrainParts::membrane);
  const MatrixXd values =
      regge_values(order, {tied.m[0], tied.m[1], tied.m[2]},
                   {tying.moments * compatible.m[0], tying.moments * compatible.m[1],
                    tying.moments * compatible.m[2]});
  CovariantStrains assumed = compatible;
  for (std::size_t r = 0; r < 3; ++r) assumed.m[r].noalias() = tying.weights[r] * values;
  return assumed;
}

}  // namespace chladni::plate
