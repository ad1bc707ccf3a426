#include "plate/shell_element.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "plate/assumed_strains.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr double kappa = 5.0 / 6.0;
constexpr double drilling_factor = 1e-3;
/// Two Gauss points through the thickness, weights 1.
const std::array<double, 2> thickness_points{-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)};

enum class Strains { all, without_shear, shear };

/// Plane stress with shear correction for (e_11, e_22, 2 e_12, 2 e_13, 2 e_23), Pa.
Matrix5d elasticity(const Material& material, Strains which)
{
  const double nu = material.poisson;
  const double plane = material.young / (1.0 - nu * nu);
  const double G = 0.5 * material.young / (1.0 + nu);
  Matrix5d C = Matrix5d::Zero();
  if (which != Strains::shear) {
    C.topLeftCorner<2, 2>() << plane, nu * plane, nu * plane, plane;
    C(2, 2) = G;
  }
  if (which != Strains::without_shear) C(3, 3) = C(4, 4) = kappa * G;
  return C;
}

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

/// The five covariant strain rows at one point and height.
Eigen::Matrix<double, 5, Eigen::Dynamic> strain_rows(const CovariantStrains& s, Index q,
                                                     double zeta)
{
  Eigen::Matrix<double, 5, Eigen::Dynamic> rows(5, s.m[0].cols());
  for (int r = 0; r < 3; ++r) {
    rows.row(r) = s.m[r].row(q) + zeta * s.b[r].row(q) + zeta * zeta * s.c[r].row(q);
  }
  for (int r = 0; r < 2; ++r) rows.row(3 + r) = s.g0[r].row(q) + zeta * s.g1[r].row(q);
  return rows;
}

/// K = sum over points of B^T C B det(g) w.
MatrixXd stiffness(const CovariantStrains& strains, const ShellFrame& frame, const Points& points,
                   const Matrix5d& C)
{
  const Index n_rows = 5 * 2 * points.size();
  StrainRows B(n_rows, strains.m[0].cols());
  StrainRows CB(n_rows, strains.m[0].cols());
  Index row = 0;
  for (const double zeta : thickness_points) {
    for (Index q = 0; q < points.size(); ++q, row += 5) {
      const LocalFrame local = local_frame(frame, q, zeta);
      B.middleRows<5>(row).noalias() = local.T * strain_rows(strains, q, zeta);
      CB.middleRows<5>(row).noalias() = (local.det * points.weight[q] * C) * B.middleRows<5>(row);
    }
  }
  return B.transpose() * CB;
}

struct ElementSize {
  double thickness_squared;
  double h_squared;  ///< a quarter of the sum of the squared straight edges: h^2 of a square
};

ElementSize element_size(mesh::Shape shape, int order, const ShellNodes& nodes)
{
  const Index last = nodes.x.rows() - 1;
  const std::vector<Index> corners = shape == mesh::Shape::triangle
                                         ? std::vector<Index>{0, order, last}
                                         : std::vector<Index>{0, order, last, last - order};
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += (nodes.x.row(corners[i]) - nodes.x.row(corners[(i + 1) % corners.size()])).squaredNorm();
  }
  return {.thickness_squared = 4.0 * nodes.D.rowwise().squaredNorm().mean(),
          .h_squared = 0.25 * sum};
}

double blend(const ElementSize& size, double c)
{
  return size.thickness_squared / (size.thickness_squared + c * size.h_squared);
}

MatrixXd quadrilateral_stiffness(int order, const ShellNodes& nodes, const Material& material)
{
  const Matrix5d C = elasticity(material, Strains::all);
  const Points full = gauss_points(mesh::Shape::quadrilateral, order + 1);
  const Basis basis = lagrange_basis(mesh::Shape::quadrilateral, order, full);
  const CovariantStrains compatible = covariant_strains(basis, nodes);
  const MatrixXd K = stiffness(assume_quadrilateral_strains(order, full, nodes, compatible),
                               shell_frame(basis, nodes), full, C);
  if (order != 2 && order != 3) return K;
  const Points reduced = gauss_points(mesh::Shape::quadrilateral, order);
  const Basis reduced_basis = lagrange_basis(mesh::Shape::quadrilateral, order, reduced);
  const MatrixXd K_reduced = stiffness(covariant_strains(reduced_basis, nodes),
                                       shell_frame(reduced_basis, nodes), reduced, C);
  const double beta = std::min(
      0.95, blend(element_size(mesh::Shape::quadrilateral, order, nodes), order == 2 ? 0.5 : 0.1));
  return beta * K_reduced + (1.0 - beta) * K;
}

MatrixXd triangle_stiffness(int order, const ShellNodes& nodes, const Material& material)
{
  const Points points = gauss_points(mesh::Shape::triangle, order + 1);
  const Basis basis = lagrange_basis(mesh::Shape::triangle, order, points);
  const ShellFrame frame = shell_frame(basis, nodes);
  const CovariantStrains compatible = covariant_strains(basis, nodes);
  const Matrix5d C_shear = elasticity(material, Strains::shear);
  const double alpha = blend(element_size(mesh::Shape::triangle, order, nodes), 0.5);
  return stiffness(assume_triangle_membrane(order, points, nodes, compatible), frame, points,
                   elasticity(material, Strains::without_shear)) +
         (1.0 - alpha) * stiffness(assume_triangle_shear(order, points, nodes, compatible), frame,
                                   points, C_shear) +
         alpha * stiffness(compatible, frame, points, C_shear);
}

MatrixXd drilling_stiffness(const Basis& basis, const ShellNodes& nodes, const Points& points,
                            const Material& material)
{
  const ShellFrame frame = shell_frame(basis, nodes);
  const double G = 0.5 * material.young / (1.0 + material.poisson);
  StrainRows B(points.size(), 6 * nodes.x.rows());
  for (Index q = 0; q < points.size(); ++q) {
    const Eigen::RowVector3d a_1 = frame.a_1.row(q);
    const Eigen::RowVector3d a_2 = frame.a_2.row(q);
    const double J = a_1.cross(a_2).norm();
    const Eigen::RowVector3d normal = a_1.cross(a_2) / J;
    for (Index i = 0; i < nodes.x.rows(); ++i) {
      // curl u . n = (u_,1 . a_2 - u_,2 . a_1) / J
      B.row(q).segment<3>(6 * i) = -0.5 * (basis.N_xi(q, i) * a_2 - basis.N_eta(q, i) * a_1) / J;
      B.row(q).segment<3>(6 * i + 3) = basis.N(q, i) * normal;
    }
    const double thickness = 2.0 * frame.d.row(q).norm();
    B.row(q) *= std::sqrt(drilling_factor * G * thickness * J * points.weight[q]);
  }
  return B.transpose() * B;
}

/// theta x D = S theta.
Matrix3d rotation_to_displacement(const Vector3d& D)
{
  Matrix3d S;
  S << 0.0, D.z(), -D.y(), -D.z(), 0.0, D.x(), D.y(), -D.x(), 0.0;
  return S;
}

/// M = int rho H^T H dV with u = H (u_i, theta_i).
MatrixXd mass(const Basis& basis, const ShellNodes& nodes, const Points& points, double density)
{
  const ShellFrame frame = shell_frame(basis, nodes);
  const Index n = nodes.x.rows();
  StrainRows H(3, 6 * n);
  StrainRows scaled(2 * points.size() * 3, 6 * n);
  Index row = 0;
  for (const double zeta : thickness_points) {
    for (Index q = 0; q < points.size(); ++q, row += 3) {
      const double det = local_frame(frame, q, zeta).det;
      for (Index i = 0; i < n; ++i) {
        H.middleCols<3>(6 * i) = basis.N(q, i) * Matrix3d::Identity();
        H.middleCols<3>(6 * i + 3) =
            zeta * basis.N(q, i) * rotation_to_displacement(nodes.D.row(i).transpose());
      }
      scaled.middleRows<3>(row) = std::sqrt(density * det * points.weight[q]) * H;
    }
  }
  return scaled.transpose() * scaled;
}

}  // namespace

void check_element_exists(mesh::Shape shape, int order)
{
  const bool quadrilateral = shape == mesh::Shape::quadrilateral && order >= 1 && order <= 4;
  const bool triangle = shape == mesh::Shape::triangle && (order == 2 || order == 3);
  if (quadrilateral || triangle) return;
  throw Error(fmt::format(
      "no shell element of order {} for {}; use quadrilaterals of order 1 to 4 or triangles of "
      "order 2 or 3",
      order, shape == mesh::Shape::triangle ? "triangles" : "this shape"));
}

ElementMatrices shell_matrices(mesh::Shape shape, int order, const ShellNodes& nodes,
                               const Material& material)
{
  check_element_exists(shape, order);
  const Points points = gauss_points(shape, order + 1);
  const Basis basis = lagrange_basis(shape, order, points);
  const MatrixXd K = shape == mesh::Shape::triangle
                         ? triangle_stiffness(order, nodes, material)
                         : quadrilateral_stiffness(order, nodes, material);
  return {.K = K + drilling_stiffness(basis, nodes, points, material),
          .M = mass(basis, nodes, points, material.density)};
}

}  // namespace chladni::plate
