#include "sound/locate.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::sound {

using Eigen::MatrixXd, Eigen::RowVectorXd;

Locator::Locator(std::shared_ptr<const AirMesh> mesh)
    : mesh_(std::move(mesh)), low_(mesh_->n_elements(), mesh_->dimension()), high_(low_)
{
  for (int e = 0; e < mesh_->n_elements(); ++e) {
    const MatrixXd x = mesh_->positions(mesh_->elements.row(e), every);
    const RowVectorXd size = x.colwise().maxCoeff() - x.colwise().minCoeff();
    low_.row(e) = x.colwise().minCoeff() - 0.05 * size;  // curved edges bulge
    high_.row(e) = x.colwise().maxCoeff() + 0.05 * size;
  }
}

std::optional<RowVectorXd> Locator::reference_place(int element, const RowVectorXd& x) const
{
  const int dimension = mesh_->dimension();
  const MatrixXd X = mesh_->positions(mesh_->elements.row(element), every);
  RowVectorXd xi = RowVectorXd::Constant(dimension, 1.0 / (dimension + 1));
  for (int step = 0; step < 20; ++step) {
    const RowVectorXd rest = x - mesh_->basis.values(xi) * X;
    MatrixXd J(dimension, dimension);
    for (int d = 0; d < dimension; ++d) J.row(d) = mesh_->basis.derivatives(xi, d) * X;
    const RowVectorXd move = rest * J.inverse();
    xi += move;
    if (!(xi.cwiseAbs().maxCoeff() < 3.0)) return std::nullopt;
    if (move.norm() < 1e-12) break;
  }
  constexpr double slack = 1e-8;
  if (xi.minCoeff() < -slack || xi.sum() > 1.0 + slack) return std::nullopt;
  return xi;
}

Eigen::RowVectorXcd Locator::value(const Eigen::Vector3d& x, const Eigen::MatrixXcd& p) const
{
  const bool mirrored = mesh_->half_space && x[2] < 0.0;
  const double z = mirrored ? -x[2] : x[2];
  RowVectorXd at(mesh_->dimension());
  if (mesh_->dimension() == 2)
    at << x.head<2>().norm(), z;
  else
    at << x[0], x[1], z;
  for (int e = 0; e < mesh_->n_elements(); ++e) {
    if ((at.array() < low_.row(e).array()).any() || (at.array() > high_.row(e).array()).any())
      continue;
    const auto xi = reference_place(e, at);
    if (!xi) continue;
    const MatrixXd N = mesh_->basis.values(*xi);
    return (mirrored ? -1.0 : 1.0) * (N * p(mesh_->elements.row(e), every));
  }
  throw Error(
      fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m is inside the body", x[0], x[1], x[2]));
}

}  // namespace chladni::sound
