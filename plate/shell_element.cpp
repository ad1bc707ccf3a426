#include "plate/shell_element.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "plate/assumed_strains.hpp"
#include "plate/rotation_bubbles.hpp"
#include "plate/strain_energy.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double drilling_factor = 1e-3;

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
  const auto root = elasticity_root(material, Strains::all);
  const Points full = gauss_points(mesh::Shape::quadrilateral, order + 1);
  const Basis basis = lagrange_basis(mesh::Shape::quadrilateral, order, full);
  const CovariantStrains compatible = covariant_strains(basis, nodes);
  const MatrixXd K = stiffness(assume_quadrilateral_strains(order, full, nodes, compatible),
                               shell_frame(basis, nodes), full, root);
  if (order != 2 && order != 3) return K;
  const Points reduced = gauss_points(mesh::Shape::quadrilateral, order);
  const Basis reduced_basis = lagrange_basis(mesh::Shape::quadrilateral, order, reduced);
  const MatrixXd K_reduced = stiffness(covariant_strains(reduced_basis, nodes),
                                       shell_frame(reduced_basis, nodes), reduced, root);
  const double beta = std::min(
      0.95, blend(element_size(mesh::Shape::quadrilateral, order, nodes), order == 2 ? 0.5 : 0.1));
  return beta * K_reduced + (1.0 - beta) * K;
}

MatrixXd triangle_stiffness(int order, const ShellNodes& nodes, const Material& material)
{
  if (order == 1) return linear_triangle_stiffness(nodes, material);
  const Points points = gauss_points(mesh::Shape::triangle, order + 1);
  const BubbleBasis basis = basis_with_bubbles(order, points);
  const ShellFrame frame = shell_frame(basis.surface, nodes);
  const CovariantStrains compatible = strains_with_bubbles(basis, nodes);
  const auto shear_root = elasticity_root(material, Strains::shear);
  const double alpha =
      order == 2 ? 0.0 : blend(element_size(mesh::Shape::triangle, order, nodes), 0.5);
  MatrixXd K = stiffness(assume_triangle_membrane(order, nodes, compatible), frame, points,
                         elasticity_root(material, Strains::without_shear)) +
               (1.0 - alpha) * stiffness(assume_triangle_shear(order, nodes, compatible), frame,
                                         points, shear_root);
  if (alpha > 0.0) K += alpha * stiffness(compatible, frame, points, shear_root);
  return eliminate_bubbles(K, nodes);
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
  return gram_matrix(B);
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
      const double det = volume_element(frame, q, zeta);
      for (Index i = 0; i < n; ++i) {
        H.middleCols<3>(6 * i) = basis.N(q, i) * Matrix3d::Identity();
        H.middleCols<3>(6 * i + 3) =
            zeta * basis.N(q, i) * rotation_to_displacement(nodes.D.row(i).transpose());
      }
      scaled.middleRows<3>(row) = std::sqrt(density * det * points.weight[q]) * H;
    }
  }
  return gram_matrix(scaled);
}

}  // namespace

void check_element_exists(mesh::Shape shape, int order)
{
  const bool quadrilateral = shape == mesh::Shape::quadrilateral && order >= 1 && order <= 4;
  const bool triangle = shape == mesh::Shape::triangle && order >= 1 && order <= 3;
  if (quadrilateral || triangle) return;
  throw Error(fmt::format(
      "no shell element of order {} for {}; use quadrilaterals of order 1 to 4 or triangles of "
      "order 1 to 3",
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
