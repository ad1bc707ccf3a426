#include "plate/elements/shell_element.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "common/error.hpp"
#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/element_rules.hpp"
#include "plate/elements/plane_element.hpp"
#include "plate/elements/rotation_bubbles.hpp"
#include "plate/elements/strain_energy.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

MatrixXd quadrilateral_stiffness(int order, const ShellNodes& nodes, const Material& material)
{
  const auto root = elasticity_root(material, Strains::all);
  const auto& [full, reduced, none] = rules_of(mesh::Shape::quadrilateral, order);
  const ShellFrame frame = shell_frame(full.basis, nodes);
  const MatrixXd K =
      stiffness(assume_quadrilateral_strains(order, full.points, nodes, frame,
                                             covariant_strains(full.basis, frame, nodes.D)),
                frame, full.points, root);
  const double beta = share_of_reduced_integration(order, nodes);
  if (beta == 0.0) return K;
  const MatrixXd K_reduced = stiffness(covariant_strains(reduced.basis, nodes),
                                       shell_frame(reduced.basis, nodes), reduced.points, root);
  return beta * K_reduced + (1.0 - beta) * K;
}

/// The bubble makes cubic strains: three Gauss points each way, one more than else.
MatrixXd linear_triangle_stiffness(const ShellNodes& nodes, const Material& material)
{
  static const Points points = gauss_points(mesh::Shape::triangle, 3);
  static const BubbleBasis basis = basis_with_bubbles(1, points);
  return stiffness(linear_triangle_strains(nodes, basis, points), shell_frame(basis.surface, nodes),
                   points, elasticity_root(material, Strains::all));
}

MatrixXd drilling_stiffness(const Rule& rule, const ShellNodes& nodes, const Material& material)
{
  const auto& [points, basis] = rule;
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

/// M = int rho u . u dV of u = sum N_i (u_i + zeta theta_i x D_i): the moments
/// m_k = int rho zeta^k N_i N_j dV give the blocks of each pair of nodes.
MatrixXd mass(const Rule& rule, const ShellNodes& nodes, double density)
{
  const ShellFrame frame = shell_frame(rule.basis, nodes);
  const Index n = nodes.x.rows();
  Eigen::MatrixX3d moment = Eigen::MatrixX3d::Zero(rule.points.size(), 3);
  const Eigen::VectorXd weight =
      density * rule.points.weight.cwiseProduct(leaning(rule.basis, nodes));
  for (const double zeta : thickness_points) {
    for (Index q = 0; q < rule.points.size(); ++q) {
      const double m = weight[q] * volume_element(frame, q, zeta);
      moment.row(q) += m * Eigen::RowVector3d(1.0, zeta, zeta * zeta);
    }
  }
  const MatrixXd& N = rule.basis.N;
  const auto weighted = [&](int k) {
    return MatrixXd(N.transpose() * moment.col(k).asDiagonal() * N);
  };
  const MatrixXd m_0 = weighted(0), m_1 = weighted(1), m_2 = weighted(2);
  MatrixXd M(6 * n, 6 * n);
  for (Index i = 0; i < n; ++i) {
    const Matrix3d S_i = rotation_to_displacement(nodes.D.row(i).transpose());
    for (Index j = 0; j < n; ++j) {
      const Matrix3d S_j = rotation_to_displacement(nodes.D.row(j).transpose());
      M.block<3, 3>(6 * i, 6 * j) = m_0(i, j) * Matrix3d::Identity();
      M.block<3, 3>(6 * i, 6 * j + 3) = m_1(i, j) * S_j;
      M.block<3, 3>(6 * i + 3, 6 * j) = m_1(i, j) * S_i.transpose();
      M.block<3, 3>(6 * i + 3, 6 * j + 3) = m_2(i, j) * S_i.transpose() * S_j;
    }
  }
  return M;
}

}  // namespace

MatrixXd triangle_stiffness_with_bubbles(int order, const ShellNodes& nodes,
                                         const Material& material)
{
  if (order == 1) return linear_triangle_stiffness(nodes, material);
  const Rules& rules = rules_of(mesh::Shape::triangle, order);
  const Points& points = rules.full.points;
  const ShellFrame frame = shell_frame(rules.full.basis, nodes);
  const CovariantStrains compatible = strains_with_bubbles(rules.bubbles, nodes);
  const auto shear_root = elasticity_root(material, Strains::shear);
  const double alpha = order == 2 ? 0.0 : thickness_blend(mesh::Shape::triangle, order, nodes, 0.5);
  MatrixXd K = stiffness(assume_triangle_membrane(order, nodes, compatible), frame, points,
                         elasticity_root(material, Strains::without_shear)) +
               (1.0 - alpha) * stiffness(assume_triangle_shear(order, nodes, compatible), frame,
                                         points, shear_root);
  if (alpha > 0.0) K += alpha * stiffness(compatible, frame, points, shear_root);
  return K;
}

void check_element_exists(mesh::Shape shape, int order)
{
  const bool quadrilateral = shape == mesh::Shape::quadrilateral && order >= 1 && order <= 4;
  const bool triangle = shape == mesh::Shape::triangle && order >= 1 && order <= 3;
  if (quadrilateral || triangle) return;
  throw Error(fmt::format(
      "no shell element of order {} for {}; use quadrilaterals of order 1 to 4 (a structured mesh: "
      "others keep some triangles) or triangles of order 1 to 3",
      order, shape == mesh::Shape::triangle ? "triangles" : "this shape"));
}

ElementMatrices shell_matrices(mesh::Shape shape, int order, const ShellNodes& nodes,
                               const Material& material)
{
  check_element_exists(shape, order);
  if (shape == mesh::Shape::quadrilateral && order > 1) {
    if (const auto plane = in_its_plane(nodes))
      return plane_matrices(order, *plane, material, share_of_reduced_integration(order, nodes));
  }
  const Rule& rule = rules_of(shape, order).full;
  const MatrixXd K =
      shape == mesh::Shape::triangle
          ? eliminate_bubbles(triangle_stiffness_with_bubbles(order, nodes, material), nodes)
          : quadrilateral_stiffness(order, nodes, material);
  return {.K = K + drilling_stiffness(rule, nodes, material),
          .M = mass(rule, nodes, material.density)};
}

}  // namespace chladni::plate
