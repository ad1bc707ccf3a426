#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <vector>

#include "common/error.hpp"
#include "plate/assumed_strains.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Points points_of(const std::vector<std::pair<double, double>>& list)
{
  const auto n = static_cast<Eigen::Index>(list.size());
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    points.xi[i] = list[i].first;
    points.eta[i] = list[i].second;
  }
  return points;
}

/// Both components of the Nedelec basis of the first kind, order p: P_(p-1)^2 + (s, -r) times the
/// homogeneous polynomials of degree p-1. [n_points x p (p + 2)]
struct NedelecBasis {
  MatrixXd first, second;
};

NedelecBasis nedelec_basis(int p, const Points& points)
{
  const MatrixXd P = monomials(p - 1, points);
  const MatrixXd top = P.rightCols(p);
  const MatrixXd zero = MatrixXd::Zero(P.rows(), P.cols());
  NedelecBasis basis{.first = MatrixXd(P.rows(), 2 * P.cols() + p),
                     .second = MatrixXd(P.rows(), 2 * P.cols() + p)};
  basis.first << P, zero, points.eta.asDiagonal() * top;
  basis.second << zero, P, -(points.xi.asDiagonal() * top);
  return basis;
}

/// Shear tying points: p on each edge (s = 0, r = 0, r + s = 1), then the inner ones.
Points shear_points(int p)
{
  const VectorXd gauss = (gauss_legendre(p).x.array() + 1.0) / 2.0;
  std::vector<std::pair<double, double>> list;
  for (const double g : gauss) list.emplace_back(g, 0.0);
  for (const double g : gauss) list.emplace_back(0.0, g);
  for (const double g : gauss) list.emplace_back(g, 1.0 - g);
  if (p == 2) list.emplace_back(1.0 / 3.0, 1.0 / 3.0);
  if (p == 3) {
    list.emplace_back(1.0 / 6.0, 1.0 / 6.0);
    list.emplace_back(2.0 / 3.0, 1.0 / 6.0);
    list.emplace_back(1.0 / 6.0, 2.0 / 3.0);
  }
  return points_of(list);
}

/// The degrees of freedom of the Nedelec space applied to fields given by their two components at
/// `shear_points`.
MatrixXd nedelec_values(int p, const MatrixXd& first, const MatrixXd& second)
{
  const Eigen::Index n_inner = first.rows() - 3 * p;
  MatrixXd values(3 * p + 2 * n_inner, first.cols());
  values << first.topRows(p), second.middleRows(p, p),
      first.middleRows(2 * p, p) - second.middleRows(2 * p, p), first.bottomRows(n_inner),
      second.bottomRows(n_inner);
  return values;
}

/// p (p + 1) / 2 points along r, on lines of constant s, at which a polynomial of degree p-1 is
/// determined; Gauss points along each line.
Points line_points(int p)
{
  if (p == 2) {
    const double g = (1.0 - 1.0 / std::sqrt(3.0)) / 2.0;
    return points_of({{g, 0.0}, {1.0 - g, 0.0}, {g, 1.0 / std::sqrt(3.0)}});
  }
  // Lines near the Gauss-Radau heights that leave room for 3, 2 and 1 Gauss points.
  const std::vector<double> heights{0.0, 0.8 / std::sqrt(5.0), 0.8165};
  std::vector<std::pair<double, double>> list;
  for (int j = 0; j < p; ++j) {
    for (const double x : gauss_legendre(p - j).x) {
      list.emplace_back((x + 1.0) / 2.0 * (1.0 - heights[j]), heights[j]);
    }
  }
  return points_of(list);
}

/// Tied strain along one edge direction at the integration points, from its values at `tying`.
MatrixXd polynomial_fit(int p, const Points& tying, const Points& integration)
{
  return monomials(p - 1, integration) * monomials(p - 1, tying).inverse();
}

}  // namespace

CovariantStrains assume_triangle_shear(int order, const Points& integration,
                                       const ShellNodes& nodes, const CovariantStrains& compatible)
{
  const Points tying = shear_points(order);
  const NedelecBasis at_tying = nedelec_basis(order, tying);
  const MatrixXd inverse = nedelec_values(order, at_tying.first, at_tying.second).inverse();
  const NedelecBasis at_gauss = nedelec_basis(order, integration);
  const CovariantStrains tied =
      covariant_strains(lagrange_basis(mesh::Shape::triangle, order, tying), nodes);
  const auto interpolate = [&](std::array<StrainRows, 2>& assumed,
                               const std::array<StrainRows, 2>& values) {
    const MatrixXd coefficients = inverse * nedelec_values(order, values[0], values[1]);
    assumed[0].noalias() = at_gauss.first * coefficients;
    assumed[1].noalias() = at_gauss.second * coefficients;
  };
  CovariantStrains assumed = compatible;
  interpolate(assumed.g0, tied.g0);
  interpolate(assumed.g1, tied.g1);
  return assumed;
}

CovariantStrains assume_triangle_membrane(int order, const Points& integration,
                                          const ShellNodes& nodes,
                                          const CovariantStrains& compatible)
{
  const Points along_r = line_points(order);
  const Points along_s{.xi = along_r.eta, .eta = along_r.xi, .weight = along_r.weight};
  const Points along_third{.xi = along_r.xi,
                           .eta = 1.0 - along_r.xi.array() - along_r.eta.array(),
                           .weight = along_r.weight};
  const auto strains_at = [&](const Points& points) {
    return covariant_strains(lagrange_basis(mesh::Shape::triangle, order, points), nodes).m;
  };
  const auto third = strains_at(along_third);
  const StrainRows e_r = polynomial_fit(order, along_r, integration) * strains_at(along_r)[0];
  const StrainRows e_s = polynomial_fit(order, along_s, integration) * strains_at(along_s)[1];
  const StrainRows e_third =
      polynomial_fit(order, along_third, integration) * (0.5 * (third[0] + third[1]) - third[2]);
  CovariantStrains assumed = compatible;
  const Basis basis = lagrange_basis(mesh::Shape::triangle, order, integration);
  assumed.m = correct_mean({e_r, e_s, 0.5 * (e_r + e_s) - e_third}, compatible.m,
                           shell_frame(basis, nodes), integration.weight);
  return assumed;
}

}  // namespace chladni::plate
