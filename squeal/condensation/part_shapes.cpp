#include "squeal/condensation/part_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double smallest = 1e-8;

/// Real and imaginary parts side by side.
MatrixXd real_columns(const MatrixXcd& Y)
{
  MatrixXd both(Y.rows(), 2 * Y.cols());
  both << Y.real(), Y.imag();
  return both;
}

MatrixXd beside(const MatrixXd& A, const MatrixXd& B)
{
  if (A.size() == 0) return B;
  MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// Left singular vectors of diag(weights) Y over the weights, and the singular values.
struct PrincipalComponents {
  MatrixXd shapes;
  VectorXd sizes;
};

PrincipalComponents principal_components(const MatrixXd& Y, const VectorXd& weights)
{
  const MatrixXd weighted = weights.asDiagonal() * Y;
  const Eigen::JacobiSVD<MatrixXd> svd(weighted, Eigen::ComputeThinU);
  return {weights.cwiseInverse().asDiagonal() * svd.matrixU(),
          svd.singularValues() / std::sqrt(0.5 * double(Y.cols()))};
}

VectorXd weights_of(const VectorXd& frequencies, double omega)
{
  return (frequencies.array().square() + omega * omega).sqrt();
}

/// Coordinates of the inertial disc with so many nodal diameters: the first ones of pairs.
std::vector<Index> first_of(const InertialDisc& disc, int n)
{
  std::vector<Index> first;
  for (Index i = 0; i < disc.n_modes(); ++i) {
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] != n) continue;
    first.push_back(i);
    if (n > 0) ++i;
  }
  return first;
}

/// What each position of the disc says of the radial shapes of one number of nodal diameters.
void add_disc(std::vector<PartShape>& shapes, std::size_t part, const Assembly& all, Index n_modes,
              std::span<const PartMotions> motions, double omega)
{
  const InertialDisc& disc = all.disc;
  const int highest = *std::ranges::max_element(disc.nodal_diameters);
  for (int n = 0; n <= highest; ++n) {
    const std::vector<Index> cosines = first_of(disc, n);
    if (cosines.empty()) continue;
    std::vector<Index> sines = cosines;
    for (Index& i : sines) ++i;
    MatrixXd Y;
    for (const PartMotions& motion : motions) {
      Y = beside(Y, real_columns(motion.disc(cosines, every)));
      if (n > 0) Y = beside(Y, real_columns(motion.disc(sines, every)));
    }
    const PrincipalComponents found =
        principal_components(Y, weights_of(disc.omega(cosines), omega));
    for (Index k = 0; k < found.sizes.size(); ++k) {
      MatrixXd columns = MatrixXd::Zero(n_modes, n > 0 ? 2 : 1);
      for (Index row = 0; row < std::ssize(all.disc_modes); ++row) {
        const Index mode = all.disc_modes[static_cast<std::size_t>(row)] - 1;
        columns(mode, 0) = disc.R(row, cosines) * found.shapes.col(k);
        if (n > 0) columns(mode, 1) = disc.R(row, sines) * found.shapes.col(k);
      }
      shapes.push_back({part, std::move(columns), found.sizes[k]});
    }
  }
}

}  // namespace

PartMotions part_motions(const Assembly& all, const AssemblyOptions& options,
                         std::span<const mbs_export::ModalBody> bodies, const BandModes& modes)
{
  const Index n = all.n_coordinates(), n_disc = all.disc.n_modes();
  MatrixXcd Z = state_scales(all).cwiseInverse().asDiagonal() * modes.X.topRows(n);
  VectorXd omega(n);
  omega << all.disc.omega, all.omega;
  for (Index k = 0; k < Z.cols(); ++k) {
    const double kinetic = std::norm(modes.lambda[k]) * Z.col(k).squaredNorm();
    const double elastic = omega.cwiseProduct(Z.col(k).cwiseAbs()).squaredNorm();
    Z.col(k) /= std::sqrt(kinetic + elastic);
  }
  PartMotions motions{.disc = Z.topRows(n_disc), .parts = {}};
  const MatrixXcd Q = all.X * Z.bottomRows(n - n_disc);
  Index first = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool turns = options.parts[i].name == options.disc;
    const Index rows = turns ? 0 : bodies[i].n_modes();
    motions.parts.push_back(Q.middleRows(first, rows));
    first += rows;
  }
  return motions;
}

std::vector<PartShape> principal_shapes(const Assembly& all, const AssemblyOptions& options,
                                        std::span<const mbs_export::ModalBody> bodies,
                                        std::span<const PartMotions> motions, double omega)
{
  std::vector<PartShape> shapes;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (options.parts[i].name == options.disc) {
      add_disc(shapes, i, all, bodies[i].n_modes(), motions, omega);
      continue;
    }
    MatrixXd Y;
    for (const PartMotions& motion : motions) Y = beside(Y, real_columns(motion.parts[i]));
    const PrincipalComponents found = principal_components(Y, weights_of(bodies[i].omega, omega));
    for (Index k = 0; k < found.sizes.size(); ++k)
      shapes.push_back({i, found.shapes.col(k), found.sizes[k]});
  }
  std::ranges::stable_sort(shapes, std::ranges::greater(), &PartShape::size);
  if (shapes.empty()) return shapes;
  const double limit = smallest * shapes.front().size;
  std::erase_if(shapes, [limit](const PartShape& shape) { return shape.size < limit; });
  return shapes;
}

MatrixXd columns_of(std::span<const PartShape> shapes, std::size_t part, Index n_modes)
{
  MatrixXd columns(n_modes, 0);
  for (const PartShape& shape : shapes) {
    if (shape.part != part) continue;
    columns.conservativeResize(n_modes, columns.cols() + shape.columns.cols());
    columns.rightCols(shape.columns.cols()) = shape.columns;
  }
  return columns;
}

}  // namespace chladni::squeal
