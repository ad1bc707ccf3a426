#include "plate/shell_resultants.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "plate/assumed_strains.hpp"
#include "plate/shell_element.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using mesh::Shape;

constexpr double kappa = 5.0 / 6.0;

/// Covariant strains of one displacement at points: those of CovariantStrains times u_e.
struct StrainValues {
  std::array<VectorXd, 3> m, b, c;
  std::array<VectorXd, 2> g0, g1;
};

template <std::size_t n>
std::array<VectorXd, n> at_points(const std::array<StrainRows, n>& rows, const VectorXd& u_e,
                                  const MatrixXd& to_points)
{
  std::array<VectorXd, n> values;
  for (std::size_t r = 0; r < n; ++r) values[r] = to_points * (rows[r] * u_e);
  return values;
}

/// @param to_points  [n_points x n_rows] interpolation from the points of `strains`
StrainValues values_of(const CovariantStrains& strains, const VectorXd& u_e,
                       const MatrixXd& to_points)
{
  return {.m = at_points(strains.m, u_e, to_points),
          .b = at_points(strains.b, u_e, to_points),
          .c = at_points(strains.c, u_e, to_points),
          .g0 = at_points(strains.g0, u_e, to_points),
          .g1 = at_points(strains.g1, u_e, to_points)};
}

/// Values of the tensor-product polynomials that are 1 at one point of a grid and 0 at the others.
MatrixXd tensor_interpolation(const VectorXd& from, const Points& to)
{
  const MatrixXd along_xi = lagrange(from, to.xi);
  const MatrixXd along_eta = lagrange(from, to.eta);
  const Index n = from.size();
  MatrixXd weights(to.size(), n * n);
  for (Index q = 0; q < to.size(); ++q) {
    for (Index j = 0; j < n; ++j) {
      weights.row(q).segment(j * n, n) = along_eta(q, j) * along_xi.row(q);
    }
  }
  return weights;
}

/// Values at some points of the polynomial nearest to the values at others.
MatrixXd polynomial_fit(int degree, const Points& from, const Points& to)
{
  return monomials(degree, to) *
         monomials(degree, from).completeOrthogonalDecomposition().pseudoInverse();
}

/// Assumed strains are known at the integration points and polynomials of order p between them;
/// compatible ones are known everywhere.
StrainValues quadrilateral_strains(int order, const ShellNodes& nodes, const VectorXd& u_e)
{
  const Points full = gauss_points(Shape::quadrilateral, order + 1);
  const Points points = resultant_points(Shape::quadrilateral, order);
  const CovariantStrains at_full =
      covariant_strains(lagrange_basis(Shape::quadrilateral, order, full), nodes);
  StrainValues values = values_of(assume_quadrilateral_strains(order, full, nodes, at_full), u_e,
                                  tensor_interpolation(gauss_legendre(order + 1).x, points));
  const StrainValues compatible =
      values_of(covariant_strains(lagrange_basis(Shape::quadrilateral, order, points), nodes), u_e,
                MatrixXd::Identity(points.size(), points.size()));
  values.b = compatible.b;
  values.c = compatible.c;
  if (order == 1) values.m = compatible.m;
  return values;
}

/// As those of quadrilaterals.
StrainValues triangle_strains(int order, const ShellNodes& nodes, const VectorXd& u_e)
{
  const Points full = gauss_points(Shape::triangle, order + 1);
  const Points points = resultant_points(Shape::triangle, order);
  const CovariantStrains at_full =
      covariant_strains(lagrange_basis(Shape::triangle, order, full), nodes);
  CovariantStrains assumed = assume_triangle_shear(order, full, nodes, at_full);
  assumed.m = assume_triangle_membrane(order, full, nodes, at_full).m;
  StrainValues values = values_of(assumed, u_e, polynomial_fit(order, full, points));
  const StrainValues compatible =
      values_of(covariant_strains(lagrange_basis(Shape::triangle, order, points), nodes), u_e,
                MatrixXd::Identity(points.size(), points.size()));
  values.b = compatible.b;
  values.c = compatible.c;
  return values;
}

/// Plane stress normal to e_3, with the shear correction, of a strain tensor.
Matrix3d stress(const Matrix3d& strain, const Vector3d& e_3, const Material& material)
{
  const double nu = material.poisson;
  const double plane = material.young / (1.0 - nu * nu);
  const double G = 0.5 * material.young / (1.0 + nu);
  const Matrix3d P = Matrix3d::Identity() - e_3 * e_3.transpose();
  const Matrix3d tangential = P * strain * P;
  const Vector3d tau = 2.0 * kappa * G * P * strain * e_3;
  return plane * ((1.0 - nu) * tangential + nu * tangential.trace() * P) + tau * e_3.transpose() +
         e_3 * tau.transpose();
}

/// Strain tensor and unit director at one point and height.
struct PointStrain {
  Matrix3d strain;
  Vector3d e_3;
  double half_thickness;
};

PointStrain point_strain(const StrainValues& s, const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  const Vector3d g_3 = frame.d.row(q);
  const double det = g_1.cross(g_2).dot(g_3);
  Matrix3d contravariant;
  contravariant << g_2.cross(g_3) / det, g_3.cross(g_1) / det, g_1.cross(g_2) / det;
  const auto in_plane = [&](std::size_t r) {
    return s.m[r][q] + zeta * s.b[r][q] + zeta * zeta * s.c[r][q];
  };
  const auto shear = [&](std::size_t r) { return 0.5 * (s.g0[r][q] + zeta * s.g1[r][q]); };
  Matrix3d covariant;
  covariant << in_plane(0), in_plane(2), shear(0), in_plane(2), in_plane(1), shear(1), shear(0),
      shear(1), 0.0;
  return {.strain = contravariant * covariant * contravariant.transpose(),
          .e_3 = g_3.normalized(),
          .half_thickness = g_3.norm()};
}

Eigen::Matrix<double, 1, 6> components(const Matrix3d& A)
{
  Eigen::Matrix<double, 1, 6> row;
  row << A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(0, 2);
  return row;
}

Points lattice_points(Shape shape, int order)
{
  const VectorXd line = VectorXd::LinSpaced(order + 1, 0.0, 1.0);
  const Points square = tensor_points(line, line);
  if (shape == Shape::quadrilateral) {
    return tensor_points(2.0 * line.array() - 1.0, 2.0 * line.array() - 1.0);
  }
  const Index n = (order + 1) * (order + 2) / 2;
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  Index k = 0;
  for (Index i = 0; i < square.size(); ++i) {
    if (square.xi[i] + square.eta[i] > 1.0 + 1e-9) continue;
    points.xi[k] = square.xi[i];
    points.eta[k++] = square.eta[i];
  }
  return points;
}

}  // namespace

Points resultant_points(Shape shape, int order)
{
  return gauss_points(shape, order);
}

ShellResultants shell_resultants(Shape shape, int order, const ShellNodes& nodes,
                                 const Material& material, const VectorXd& u_e)
{
  check_element_exists(shape, order);
  const Points points = resultant_points(shape, order);
  const ShellFrame frame = shell_frame(lagrange_basis(shape, order, points), nodes);
  const StrainValues strains = shape == Shape::triangle ? triangle_strains(order, nodes, u_e)
                                                        : quadrilateral_strains(order, nodes, u_e);
  const Index n = points.size();
  ShellResultants result{
      .N = MatrixXd::Zero(n, 6), .M = MatrixXd::Zero(n, 6), .Q = MatrixXd::Zero(n, 3)};
  for (const double zeta : {-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)}) {
    for (Index q = 0; q < n; ++q) {
      const auto [strain, e_3, half] = point_strain(strains, frame, q, zeta);
      const Matrix3d sigma = stress(strain, e_3, material);
      const Vector3d tau = sigma * e_3;
      const Matrix3d tangential = sigma - tau * e_3.transpose() - e_3 * tau.transpose();
      result.N.row(q) += half * components(tangential);
      result.M.row(q) += half * half * zeta * components(tangential);
      result.Q.row(q) += half * tau.transpose();
    }
  }
  return result;
}

MatrixXd extrapolation_to_nodes(Shape shape, int order)
{
  const Points nodes = lattice_points(shape, order);
  if (shape == Shape::quadrilateral) {
    return tensor_interpolation(gauss_legendre(order).x, nodes);
  }
  return polynomial_fit(order - 1, resultant_points(shape, order), nodes);
}

}  // namespace chladni::plate
