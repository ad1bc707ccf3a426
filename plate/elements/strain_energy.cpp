#include "plate/elements/strain_energy.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr double kappa = 5.0 / 6.0;

/// Transformation of the covariant components (e_11, e_22, e_12, 2 e_13, 2 e_23) into Cartesian
/// ones (e_11, e_22, 2 e_12, 2 e_13, 2 e_23) of a frame whose third axis is the director, and
/// det(g).
struct LocalFrame {
  Matrix5d T;
  double det;
};

LocalFrame local_frame(const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  const Vector3d g_3 = frame.d.row(q);
  const double det = g_1.cross(g_2).dot(g_3);
  const Vector3d e_3 = g_3.normalized();
  const Vector3d e_1 = g_2.cross(e_3).normalized();
  Matrix3d e, contravariant;
  e << e_1, e_3.cross(e_1), e_3;
  contravariant << g_2.cross(g_3) / det, g_3.cross(g_1) / det, g_1.cross(g_2) / det;
  const Matrix3d p = e.transpose() * contravariant;  // p_ik = e_i . g^k
  constexpr std::array<std::pair<int, int>, 5> cartesian{{{0, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}}};
  Matrix5d T;
  for (int row = 0; row < 5; ++row) {
    const auto [i, j] = cartesian[row];
    const double engineering = i == j ? 1.0 : 2.0;
    T.row(row) << p(i, 0) * p(j, 0), p(i, 1) * p(j, 1), p(i, 0) * p(j, 1) + p(i, 1) * p(j, 0),
        0.5 * (p(i, 0) * p(j, 2) + p(i, 2) * p(j, 0)),
        0.5 * (p(i, 1) * p(j, 2) + p(i, 2) * p(j, 1));
    T.row(row) *= engineering;
  }
  return {.T = T, .det = det};
}

using FiveRows = Eigen::Matrix<double, 5, Eigen::Dynamic, Eigen::RowMajor>;

/// The five covariant strain rows at one point and height.
FiveRows strain_rows(const CovariantStrains& s, Index q, double zeta)
{
  FiveRows rows(5, s.m[0].cols());
  for (int r = 0; r < 3; ++r)
    rows.row(r) = s.m[r].row(q) + zeta * s.b[r].row(q) + zeta * zeta * s.c[r].row(q);
  for (int r = 0; r < 2; ++r) rows.row(3 + r) = s.g0[r].row(q) + zeta * s.g1[r].row(q);
  return rows;
}

}  // namespace

const std::array<double, 2> thickness_points{-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)};

Eigen::Matrix<double, Eigen::Dynamic, 5> elasticity_root(const Material& material, Strains which)
{
  const double nu = material.poisson;
  const double plane = std::sqrt(material.young / (1.0 - nu * nu));
  const double G = 0.5 * material.young / (1.0 + nu);
  Matrix5d S = Matrix5d::Zero();
  // [1 nu; nu 1] = [1 0; nu c] [1 nu; 0 c], c^2 = 1 - nu^2
  S.topLeftCorner<2, 2>() << plane, nu * plane, 0.0, plane * std::sqrt(1.0 - nu * nu);
  S(2, 2) = std::sqrt(G);
  S(3, 3) = S(4, 4) = std::sqrt(kappa * G);
  switch (which) {
    case Strains::without_shear:
      return S.topRows<3>();
    case Strains::shear:
      return S.bottomRows<2>();
    case Strains::all:
      break;
  }
  return S;
}

double volume_element(const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  return g_1.cross(g_2).dot(frame.d.row(q));
}

Eigen::VectorXd leaning(const Basis& basis, const ShellNodes& nodes)
{
  const NodeVectors& x = nodes.surface.size() > 0 ? nodes.surface : nodes.x;
  const NodeVectors a_1 = basis.N_xi * x, a_2 = basis.N_eta * x, d = basis.N * nodes.D;
  Eigen::VectorXd factor = basis.N * nodes.D.rowwise().norm();  // t / 2
  for (Index q = 0; q < factor.size(); ++q) {
    const Eigen::RowVector3d area = a_1.row(q).cross(a_2.row(q));
    factor[q] *= area.norm() / area.dot(d.row(q));
  }
  return factor;
}

MatrixXd stiffness(const CovariantStrains& strains, const ShellFrame& frame, const Points& points,
                   const Eigen::Matrix<double, Eigen::Dynamic, 5>& root)
{
  const Index n = root.rows();
  StrainRows R(n * 2 * points.size(), strains.m[0].cols());
  Index row = 0;
  for (const double zeta : thickness_points) {
    for (Index q = 0; q < points.size(); ++q, row += n) {
      const LocalFrame local = local_frame(frame, q, zeta);
      const Eigen::Matrix<double, Eigen::Dynamic, 5> weighted =
          std::sqrt(local.det * points.weight[q]) * root * local.T;
      // Coefficient by coefficient: the matrices are too small for a blocked product.
      R.middleRows(row, n) = weighted.lazyProduct(strain_rows(strains, q, zeta));
    }
  }
  return gram_matrix(R);
}

}  // namespace chladni::plate
