#include <map>

#include "plate/elements/assumed_strains.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Tensor-product interpolation from (xi, eta) coordinates of tying points to the Gauss points.
Tying::Component tensor_component(int order, const VectorXd& xi, const VectorXd& eta)
{
  const VectorXd gauss = gauss_legendre(order + 1).x;
  const MatrixXd along_xi = lagrange(xi, gauss);
  const MatrixXd along_eta = lagrange(eta, gauss);
  const Eigen::Index n = gauss.size();
  MatrixXd weights(n * n, xi.size() * eta.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      weights.row(j * n + i) =
          (along_xi.row(i).transpose() * along_eta.row(j)).reshaped().transpose();
    }
  }
  return {.basis = lagrange_basis(mesh::Shape::quadrilateral, order, tensor_points(xi, eta)),
          .weights = weights};
}

Tying make_tying(int order)
{
  const VectorXd reduced = gauss_legendre(order).x;
  const VectorXd full = gauss_legendre(order + 1).x;
  const VectorXd edges = gauss_lobatto(order + 1);
  return {
      .shear = {tensor_component(order, reduced, edges), tensor_component(order, edges, reduced)},
      .membrane = {tensor_component(order, reduced, full), tensor_component(order, full, reduced),
                   tensor_component(order, reduced, reduced)}};
}

}  // namespace

const Tying& quadrilateral_tying(int order)
{
  static std::map<int, Tying> cache;
  const auto it = cache.find(order);
  return it != cache.end() ? it->second : cache.emplace(order, make_tying(order)).first->second;
}

CovariantStrains assume_quadrilateral_strains(int order, const Points& integration,
                                              const ShellNodes& nodes, const ShellFrame& frame,
                                              const CovariantStrains& compatible)
{
  const Tying& tying = quadrilateral_tying(order);
  CovariantStrains assumed = compatible;
  for (std::size_t A = 0; A < 2; ++A) {
    const CovariantStrains tied =
        covariant_strains(tying.shear[A].basis, nodes, StrainParts::shear);
    assumed.g0[A].noalias() = tying.shear[A].weights * tied.g0[A];
    assumed.g1[A].noalias() = tying.shear[A].weights * tied.g1[A];
  }
  if (order == 1) {  // tying at one point would fail the membrane patch test
    assumed.m = assume_bilinear_membrane(integration, nodes);
    return assumed;
  }
  for (std::size_t r = 0; r < 3; ++r) {
    const CovariantStrains tied =
        covariant_strains(tying.membrane[r].basis, nodes, StrainParts::membrane);
    assumed.m[r].noalias() = tying.membrane[r].weights * tied.m[r];
  }
  assumed.m = correct_mean(assumed.m, compatible.m, frame, integration.weight);
  return assumed;
}

}  // namespace chladni::plate
