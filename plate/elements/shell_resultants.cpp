#include "plate/elements/shell_resultants.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/shell_element.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using mesh::Shape;

constexpr double shear_correction = 5.0 / 6.0;

/// Covariant strains of some displacements at points, one column each: those of CovariantStrains
/// times U_e.
struct StrainValues {
  std::array<MatrixXd, 3> m, b, c;
  std::array<MatrixXd, 2> g0, g1;
};

template <std::size_t n>
std::array<MatrixXd, n> at_points(const std::array<StrainRows, n>& rows, const MatrixXd& U_e,
                                  const MatrixXd& to_points)
{
  std::array<MatrixXd, n> values;
  for (std::size_t r = 0; r < n; ++r) values[r] = to_points * (rows[r] * U_e);
  return values;
}

/// @param to_points  [n_points x n_rows] interpolation from the points of `strains`
StrainValues values_of(const CovariantStrains& strains, const MatrixXd& U_e,
                       const MatrixXd& to_points)
{
  return {.m = at_points(strains.m, U_e, to_points),
          .b = at_points(strains.b, U_e, to_points),
          .c = at_points(strains.c, U_e, to_points),
          .g0 = at_points(strains.g0, U_e, to_points),
          .g1 = at_points(strains.g1, U_e, to_points)};
}

/// Values of the tensor-product polynomials that are 1 at one point of a grid and 0 at the others.
MatrixXd tensor_interpolation(const VectorXd& from, const Points& to)
{
  const MatrixXd along_xi = lagrange(from, to.xi);
  const MatrixXd along_eta = lagrange(from, to.eta);
  const Index n = from.size();
  MatrixXd weights(to.size(), n * n);
  for (Index q = 0; q < to.size(); ++q)
    for (Index j = 0; j < n; ++j)
      weights.row(q).segment(j * n, n) = along_eta(q, j) * along_xi.row(q);
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
StrainValues quadrilateral_strains(int order, const ShellNodes& nodes, const MatrixXd& U_e)
{
  const Points full = gauss_points(Shape::quadrilateral, order + 1);
  const Points points = resultant_points(Shape::quadrilateral, order);
  const Basis basis = lagrange_basis(Shape::quadrilateral, order, full);
  StrainValues values =
      values_of(assume_quadrilateral_strains(order, full, nodes, shell_frame(basis, nodes),
                                             covariant_strains(basis, nodes)),
                U_e, tensor_interpolation(gauss_legendre(order + 1).x, points));
  const StrainValues compatible =
      values_of(covariant_strains(lagrange_basis(Shape::quadrilateral, order, points), nodes), U_e,
                MatrixXd::Identity(points.size(), points.size()));
  values.b = compatible.b;
  values.c = compatible.c;
  if (order == 1) {  // of degree 2, beyond two points, but known everywhere
    values.m = at_points(assume_bilinear_membrane(points, nodes), U_e,
                         MatrixXd::Identity(points.size(), points.size()));
  }
  return values;
}

/// As those of quadrilaterals, of the nodes and the bubbles that they turn.
StrainValues triangle_strains(int order, const ShellNodes& nodes, const Material& material,
                              const MatrixXd& U_e)
{
  const MatrixXd K = triangle_stiffness_with_bubbles(order, nodes, material);
  const MatrixXd U = motion_with_bubbles(K, nodes) * U_e;
  const Points points = resultant_points(Shape::triangle, order);
  const BubbleBasis basis = basis_with_bubbles(order, points);
  const MatrixXd identity = MatrixXd::Identity(points.size(), points.size());
  if (order == 1) return values_of(linear_triangle_strains(nodes, basis, points), U, identity);
  const Points full = gauss_points(Shape::triangle, order + 1);
  const CovariantStrains at_full = strains_with_bubbles(basis_with_bubbles(order, full), nodes);
  CovariantStrains assumed = assume_triangle_shear(order, nodes, at_full);
  assumed.m = assume_triangle_membrane(order, nodes, at_full).m;
  StrainValues values = values_of(assumed, U, polynomial_fit(order, full, points));
  const StrainValues compatible = values_of(strains_with_bubbles(basis, nodes), U, identity);
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
  const Vector3d tau = 2.0 * shear_correction * G * P * strain * e_3;
  return plane * ((1.0 - nu) * tangential + nu * tangential.trace() * P) + tau * e_3.transpose() +
         e_3 * tau.transpose();
}

/// Where strains are known: point q of the frame, height zeta.
struct Place {
  Index q;
  double zeta;
  Matrix3d contravariant;
  Vector3d e_3;
  double half_thickness;
};

Place place_at(const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  const Vector3d g_3 = frame.d.row(q);
  const double det = g_1.cross(g_2).dot(g_3);
  Matrix3d contravariant;
  contravariant << g_2.cross(g_3) / det, g_3.cross(g_1) / det, g_1.cross(g_2) / det;
  return {.q = q,
          .zeta = zeta,
          .contravariant = contravariant,
          .e_3 = g_3.normalized(),
          .half_thickness = g_3.norm()};
}

/// Strain tensor of one column.
Matrix3d strain_at(const StrainValues& s, const Place& place, Index column)
{
  const Index q = place.q;
  const double zeta = place.zeta;
  const auto in_plane = [&](std::size_t r) {
    return s.m[r](q, column) + zeta * s.b[r](q, column) + zeta * zeta * s.c[r](q, column);
  };
  const auto shear = [&](std::size_t r) {
    return 0.5 * (s.g0[r](q, column) + zeta * s.g1[r](q, column));
  };
  Matrix3d covariant;
  covariant << in_plane(0), in_plane(2), shear(0), in_plane(2), in_plane(1), shear(1), shear(0),
      shear(1), 0.0;
  return place.contravariant * covariant * place.contravariant.transpose();
}

Eigen::Matrix<double, 1, 6> voigt_components(const Matrix3d& A)
{
  Eigen::Matrix<double, 1, 6> row;
  row << A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(0, 2);
  return row;
}

/// Adds what the stress at one height has of the section forces.
void add_stress(const Matrix3d& sigma, const Place& place, ShellResultants& result)
{
  const double half = place.half_thickness;
  const Vector3d tau = sigma * place.e_3;
  const Matrix3d tangential = sigma - tau * place.e_3.transpose() - place.e_3 * tau.transpose();
  result.N.row(place.q) += half * voigt_components(tangential);
  result.M.row(place.q) += half * half * place.zeta * voigt_components(tangential);
  result.Q.row(place.q) += half * tau.transpose();
}

Points lattice_points(Shape shape, int order)
{
  const VectorXd line = VectorXd::LinSpaced(order + 1, 0.0, 1.0);
  const Points square = tensor_points(line, line);
  if (shape == Shape::quadrilateral)
    return tensor_points(2.0 * line.array() - 1.0, 2.0 * line.array() - 1.0);
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

std::vector<ShellResultants> shell_resultants_of(Shape shape, int order, const ShellNodes& nodes,
                                                 const Material& material, const MatrixXd& U_e)
{
  check_element_exists(shape, order);
  const Points points = resultant_points(shape, order);
  const ShellFrame frame = shell_frame(lagrange_basis(shape, order, points), nodes);
  const StrainValues strains = shape == Shape::triangle
                                   ? triangle_strains(order, nodes, material, U_e)
                                   : quadrilateral_strains(order, nodes, U_e);
  const Index n = points.size();
  std::vector<ShellResultants> results(
      static_cast<std::size_t>(U_e.cols()),
      {.N = MatrixXd::Zero(n, 6), .M = MatrixXd::Zero(n, 6), .Q = MatrixXd::Zero(n, 3)});
  for (const double zeta : {-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)}) {
    for (Index q = 0; q < n; ++q) {
      const Place place = place_at(frame, q, zeta);
      for (Index column = 0; column < U_e.cols(); ++column) {
        add_stress(stress(strain_at(strains, place, column), place.e_3, material), place,
                   results[static_cast<std::size_t>(column)]);
      }
    }
  }
  return results;
}

ShellResultants shell_resultants(Shape shape, int order, const ShellNodes& nodes,
                                 const Material& material, const VectorXd& u_e)
{
  return shell_resultants_of(shape, order, nodes, material, u_e).front();
}

MatrixXd extrapolation_to_nodes(Shape shape, int order)
{
  const Points nodes = lattice_points(shape, order);
  if (shape == Shape::quadrilateral) return tensor_interpolation(gauss_legendre(order).x, nodes);
  return polynomial_fit(order - 1, resultant_points(shape, order), nodes);
}

}  // namespace chladni::plate
