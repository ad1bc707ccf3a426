#include <Eigen/Dense>

#include "plate/assumed_strains.hpp"
#include "plate/strain_energy.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The linear basis and, as a fourth function, the bubble 27 r s (1 - r - s).
Basis basis_with_bubble(const Points& points)
{
  const Basis linear = lagrange_basis(mesh::Shape::triangle, 1, points);
  const auto r = points.xi.array(), s = points.eta.array();
  Basis basis{.N = MatrixXd(points.size(), 4),
              .N_xi = MatrixXd(points.size(), 4),
              .N_eta = MatrixXd(points.size(), 4)};
  basis.N << linear.N, (27.0 * r * s * (1.0 - r - s)).matrix();
  basis.N_xi << linear.N_xi, (27.0 * s * (1.0 - 2.0 * r - s)).matrix();
  basis.N_eta << linear.N_eta, (27.0 * r * (1.0 - r - 2.0 * s)).matrix();
  return basis;
}

/// The fourth node carries the rotation of the bubble alone.
CovariantStrains strains_with_bubble(const Points& points, const ShellNodes& nodes)
{
  NodeVectors D(4, 3);
  D << nodes.D, nodes.D.colwise().mean();
  return covariant_strains(basis_with_bubble(points),
                           shell_frame(lagrange_basis(mesh::Shape::triangle, 1, points), nodes), D);
}

/// A to C, near the corners, and D to F, at the distance 1e-4 from the centre.
Points tying_points()
{
  constexpr double third = 1.0 / 3.0, sixth = 1.0 / 6.0, d = 1e-4;
  Points points{.xi = VectorXd(6), .eta = VectorXd(6), .weight = {}};
  points.xi << sixth, 4.0 * sixth, sixth, third + d, third - 2.0 * d, third + d;
  points.eta << 4.0 * sixth, sixth, sixth, third - 2.0 * d, third + d, third + d;
  return points;
}

/// A constant shear and one that turns about the centre, from its values at `tying_points`.
std::array<StrainRows, 2> tied_shear(const std::array<StrainRows, 2>& g, const Points& integration)
{
  constexpr int A = 0, B = 1, C = 2, D = 3, E = 4, F = 5;
  const StrainRows mean_C = (g[0].row(C) + g[1].row(C)) / 3.0;
  const StrainRows constant_r = 2.0 / 3.0 * (g[0].row(B) - 0.5 * g[1].row(B)) + mean_C;
  const StrainRows constant_s = 2.0 / 3.0 * (g[1].row(A) - 0.5 * g[0].row(A)) + mean_C;
  const StrainRows turn = (g[0].row(F) - g[0].row(D) - g[1].row(F) + g[1].row(E)) / 3.0;
  const VectorXd ones = VectorXd::Ones(integration.size());
  return {ones * constant_r + (3.0 * integration.eta - ones) * turn,
          ones * constant_s + (ones - 3.0 * integration.xi) * turn};
}

/// K without its last three DOFs, the rotation of the bubble, which no load drives. The bubble has
/// no stiffness about the director `d`: that direction is held.
MatrixXd without_bubble(const MatrixXd& K, const Eigen::Vector3d& d)
{
  constexpr Eigen::Index n = 18;
  const Eigen::Matrix3d K_bb = K.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d held = K_bb + K_bb.trace() * d * d.transpose();
  const MatrixXd K_bn = K.bottomLeftCorner(3, n);
  const MatrixXd condensed = K.topLeftCorner(n, n) - K_bn.transpose() * held.llt().solve(K_bn);
  return 0.5 * (condensed + condensed.transpose());
}

}  // namespace

MatrixXd linear_triangle_stiffness(const ShellNodes& nodes, const Material& material)
{
  const Points points = gauss_points(mesh::Shape::triangle, 3);
  const ShellFrame frame = shell_frame(lagrange_basis(mesh::Shape::triangle, 1, points), nodes);
  CovariantStrains strains = strains_with_bubble(points, nodes);
  const CovariantStrains tied = strains_with_bubble(tying_points(), nodes);
  strains.g0 = tied_shear(tied.g0, points);
  strains.g1 = tied_shear(tied.g1, points);
  const MatrixXd K = stiffness(strains, frame, points, elasticity_root(material, Strains::all));
  return without_bubble(K, nodes.D.colwise().mean().transpose().normalized());
}

}  // namespace chladni::plate
