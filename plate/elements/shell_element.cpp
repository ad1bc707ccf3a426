#include "plate/elements/shell_element.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/shell_strains.hpp"

namespace chladni::plate {

using Eigen::ArrayXd, Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;

namespace {

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
Matrix3d director_rotation_to_displacement(const Vector3d& D)
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
    const Matrix3d S_i = director_rotation_to_displacement(nodes.D.row(i).transpose());
    for (Index j = 0; j < n; ++j) {
      const Matrix3d S_j = director_rotation_to_displacement(nodes.D.row(j).transpose());
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

namespace {

Rules make_rules(mesh::Shape shape, int order)
{
  Rules rules;
  for (auto [rule, n] : {std::pair{&rules.full, order + 1}, {&rules.reduced, order}}) {
    rule->points = gauss_points(shape, n);
    rule->basis = lagrange_basis(shape, order, rule->points);
  }
  if (shape == mesh::Shape::triangle) rules.bubbles = basis_with_bubbles(order, rules.full.points);
  return rules;
}

}  // namespace

const Rules& rules_of(mesh::Shape shape, int order)
{
  static std::map<std::pair<mesh::Shape, int>, Rules> cache;
  const std::pair key{shape, order};
  const auto it = cache.find(key);
  return it != cache.end() ? it->second
                           : cache.emplace(key, make_rules(shape, order)).first->second;
}

double thickness_blend(mesh::Shape shape, int order, const ShellNodes& nodes, double c)
{
  const Index last = nodes.x.rows() - 1;
  const std::vector<Index> corners = shape == mesh::Shape::triangle
                                         ? std::vector<Index>{0, order, last}
                                         : std::vector<Index>{0, order, last, last - order};
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += (nodes.x.row(corners[i]) - nodes.x.row(corners[(i + 1) % corners.size()])).squaredNorm();
  const double thickness_squared = 4.0 * nodes.D.rowwise().squaredNorm().mean();
  return thickness_squared / (thickness_squared + c * 0.25 * sum);
}

double share_of_reduced_integration(int order, const ShellNodes& nodes)
{
  if (order != 2 && order != 3) return 0.0;
  const double c = order == 2 ? 0.5 : 0.1;
  return std::min(0.95, thickness_blend(mesh::Shape::quadrilateral, order, nodes, c));
}

namespace {

constexpr double plane = 1e-12;  // of the element's size, and of the directors

// Columns of all strain rows stand by components: first those of u_1 (or w) at all nodes, then u_2.

/// Tangents (a_1, a_2) in the plane at points, and the area element.
struct PlaneFrame {
  Eigen::MatrixX2d a_1, a_2;
  ArrayXd J;
};

PlaneFrame plane_frame(const Basis& basis, const PlaneShell& shell)
{
  PlaneFrame frame{.a_1 = basis.N_xi * shell.x, .a_2 = basis.N_eta * shell.x, .J = {}};
  frame.J = frame.a_1.col(0).array() * frame.a_2.col(1).array() -
            frame.a_1.col(1).array() * frame.a_2.col(0).array();
  return frame;
}

/// a . f of a vector field f = sum N_i f_i.
StrainRows along(const Eigen::MatrixX2d& a, const MatrixXd& N)
{
  StrainRows rows(N.rows(), 2 * N.cols());
  rows.leftCols(N.cols()) = a.col(0).asDiagonal() * N;
  rows.rightCols(N.cols()) = a.col(1).asDiagonal() * N;
  return rows;
}

/// Covariant components (11, 22, 12) of the strain of plane displacements.
StrainRows strain_component(std::size_t r, const Basis& basis, const PlaneFrame& frame)
{
  if (r == 0) return along(frame.a_1, basis.N_xi);
  if (r == 1) return along(frame.a_2, basis.N_eta);
  return 0.5 * (along(frame.a_1, basis.N_eta) + along(frame.a_2, basis.N_xi));
}

std::array<StrainRows, 3> compatible_strains(const Basis& basis, const PlaneFrame& frame)
{
  return {strain_component(0, basis, frame), strain_component(1, basis, frame),
          strain_component(2, basis, frame)};
}

/// Shear a_A . (grad w + phi) of (w, phi_1, phi_2).
StrainRows shear_component(std::size_t A, const Basis& basis, const PlaneFrame& frame)
{
  StrainRows rows(basis.N.rows(), 3 * basis.N.cols());
  rows << (A == 0 ? basis.N_xi : basis.N_eta), along(A == 0 ? frame.a_1 : frame.a_2, basis.N);
  return rows;
}

std::array<StrainRows, 3> assumed_strains(int order, const PlaneShell& shell,
                                          const std::array<StrainRows, 3>& compatible,
                                          const PlaneFrame& frame)
{
  const Tying& tying = quadrilateral_tying(order);
  std::array<StrainRows, 3> assumed;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto& [basis, weights] = tying.membrane[r];
    assumed[r].noalias() = weights * strain_component(r, basis, plane_frame(basis, shell));
  }
  const Index n = frame.J.size();
  ShellFrame in_space;
  in_space.a_1.setZero(n, 3);
  in_space.a_2.setZero(n, 3);
  in_space.a_1.leftCols<2>() = frame.a_1;
  in_space.a_2.leftCols<2>() = frame.a_2;
  const Points& points = rules_of(mesh::Shape::quadrilateral, order).full.points;
  return correct_mean(assumed, compatible, in_space, points.weight);
}

std::array<StrainRows, 2> assumed_shear(int order, const PlaneShell& shell)
{
  const Tying& tying = quadrilateral_tying(order);
  std::array<StrainRows, 2> assumed;
  for (std::size_t A = 0; A < 2; ++A) {
    const auto& [basis, weights] = tying.shear[A];
    assumed[A].noalias() = weights * shear_component(A, basis, plane_frame(basis, shell));
  }
  return assumed;
}

/// p_ia = e_i . g^a of the axes of the plane and the contravariant base vectors.
struct Contravariant {
  std::array<std::array<ArrayXd, 2>, 2> p;
  explicit Contravariant(const PlaneFrame& f)
      : p{{{f.a_2.col(1).array() / f.J, -f.a_1.col(1).array() / f.J},
           {-f.a_2.col(0).array() / f.J, f.a_1.col(0).array() / f.J}}}
  {}
};

/// sum w J E^T C E with E the Cartesian strains of covariant ones and C = S^T S.
MatrixXd strain_energy(const std::array<StrainRows, 3>& E, const PlaneFrame& frame,
                       const Points& points, const Matrix3d& S)
{
  const auto p = Contravariant(frame).p;
  const auto cartesian = [&](std::size_t i, std::size_t j) {
    return std::array<ArrayXd, 3>{p[i][0] * p[j][0], p[i][1] * p[j][1],
                                  p[i][0] * p[j][1] + p[i][1] * p[j][0]};
  };
  std::array<std::array<ArrayXd, 3>, 3> T{cartesian(0, 0), cartesian(1, 1), cartesian(0, 1)};
  const ArrayXd root = (points.weight.array() * frame.J).sqrt();
  const Index n = points.size();
  StrainRows R(3 * n, E[0].cols());
  for (std::size_t r = 0; r < 3; ++r) {
    const auto row = static_cast<Index>(r);
    const auto coefficient = [&](std::size_t s) {
      ArrayXd sum = S(row, 0) * T[0][s] + S(row, 1) * T[1][s] + 2.0 * S(row, 2) * T[2][s];
      return Eigen::VectorXd(root * sum);
    };
    R.middleRows(row * n, n) = coefficient(0).asDiagonal() * E[0];
    R.middleRows(row * n, n) += coefficient(1).asDiagonal() * E[1];
    R.middleRows(row * n, n) += coefficient(2).asDiagonal() * E[2];
  }
  return gram_matrix(R);
}

/// sum w J |gamma|^2 with gamma the Cartesian shear of the covariant one.
MatrixXd shear_energy(const std::array<StrainRows, 2>& g, const PlaneFrame& frame,
                      const Points& points)
{
  const auto p = Contravariant(frame).p;
  const ArrayXd root = (points.weight.array() * frame.J).sqrt();
  const Index n = points.size();
  StrainRows R(2 * n, g[0].cols());
  for (std::size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Index>(i) * n;
    R.middleRows(row, n) = (root * p[i][0]).matrix().asDiagonal() * g[0];
    R.middleRows(row, n) += (root * p[i][1]).matrix().asDiagonal() * g[1];
  }
  return gram_matrix(R);
}

/// sum w J (theta . n - curl u . n / 2)^2 of (u_1, u_2, theta . n).
MatrixXd drilling_energy(const Rule& rule, const PlaneFrame& frame)
{
  const auto& [points, basis] = rule;
  const Eigen::VectorXd root = (points.weight.array() * frame.J).sqrt();
  const Eigen::VectorXd half = -0.5 * root.array() / frame.J;
  StrainRows R(points.size(), 3 * basis.N.cols());
  R << half.asDiagonal() * (along(frame.a_2, basis.N_xi) - along(frame.a_1, basis.N_eta)),
      root.asDiagonal() * basis.N;
  return gram_matrix(R);
}

/// Adds `scale` times a matrix of some components, by components, to one of all six, by nodes.
/// @param place  of each component among the six; negative components stand with their sign turned
template <std::size_t n_c>
void scatter(const MatrixXd& A, double scale, const std::array<std::pair<int, double>, n_c>& place,
             MatrixXd& K)
{
  const Index n = A.rows() / static_cast<Index>(n_c);
  for (std::size_t d = 0; d < n_c; ++d) {
    for (std::size_t c = 0; c < n_c; ++c) {
      const double signed_scale = scale * place[c].second * place[d].second;
      K(Eigen::seqN(place[c].first, n, 6), Eigen::seqN(place[d].first, n, 6)) +=
          signed_scale * A.block(static_cast<Index>(c) * n, static_cast<Index>(d) * n, n, n);
    }
  }
}

constexpr std::array<std::pair<int, double>, 2> of_u{{{0, 1.0}, {1, 1.0}}};
constexpr std::array<std::pair<int, double>, 2> of_phi{{{4, 1.0}, {3, -1.0}}};  // theta x n
constexpr std::array<std::pair<int, double>, 3> of_w_phi{{{2, 1.0}, {4, 1.0}, {3, -1.0}}};
constexpr std::array<std::pair<int, double>, 3> of_drilling{{{0, 1.0}, {1, 1.0}, {5, 1.0}}};

MatrixXd plane_stiffness(int order, const PlaneShell& shell, const Material& material, double beta)
{
  const auto& [full, reduced, none] = rules_of(mesh::Shape::quadrilateral, order);
  const auto root = elasticity_root(material, Strains::all);
  const Matrix3d S = root.topLeftCorner<3, 3>();
  const double kappa_G = root(3, 3) * root(3, 3);
  const double t = shell.thickness;
  const double bending = t * t * t / 12.0;
  const PlaneFrame frame = plane_frame(full.basis, shell);
  const std::array<StrainRows, 3> E = compatible_strains(full.basis, frame);
  const double above = 1.0 - beta;
  MatrixXd K = MatrixXd::Zero(6 * shell.x.rows(), 6 * shell.x.rows());
  scatter(strain_energy(assumed_strains(order, shell, E, frame), frame, full.points, S), above * t,
          of_u, K);
  scatter(strain_energy(E, frame, full.points, S), above * bending, of_phi, K);
  scatter(shear_energy(assumed_shear(order, shell), frame, full.points), above * kappa_G * t,
          of_w_phi, K);
  const double G = 0.5 * material.young / (1.0 + material.poisson);
  scatter(drilling_energy(full, frame), drilling_factor * G * t, of_drilling, K);
  if (beta == 0.0) return K;
  const PlaneFrame at_reduced = plane_frame(reduced.basis, shell);
  const MatrixXd K_E =
      strain_energy(compatible_strains(reduced.basis, at_reduced), at_reduced, reduced.points, S);
  scatter(K_E, beta * t, of_u, K);
  scatter(K_E, beta * bending, of_phi, K);
  scatter(shear_energy({shear_component(0, reduced.basis, at_reduced),
                        shear_component(1, reduced.basis, at_reduced)},
                       at_reduced, reduced.points),
          beta * kappa_G * t, of_w_phi, K);
  return K;
}

MatrixXd plane_mass(int order, const PlaneShell& shell, double density)
{
  const auto& [points, basis] = rules_of(mesh::Shape::quadrilateral, order).full;
  const PlaneFrame frame = plane_frame(basis, shell);
  const Eigen::VectorXd weight = density * points.weight.array() * frame.J;
  const MatrixXd N_N = basis.N.transpose() * weight.asDiagonal() * basis.N;
  const double t = shell.thickness;
  MatrixXd M = MatrixXd::Zero(6 * shell.x.rows(), 6 * shell.x.rows());
  for (const int c : {0, 1, 2, 3, 4})
    scatter<1>(N_N, c < 3 ? t : t * t * t / 12.0, {{{c, 1.0}}}, M);
  return M;
}

/// Q^T A Q for each block of a displacement or rotation.
void turn(MatrixXd& A, const Matrix3d& Q)
{
  if (Q.isIdentity(0.0)) return;
  for (Index j = 0; j < A.cols(); j += 3)
    for (Index i = 0; i < A.rows(); i += 3)
      A.block<3, 3>(i, j) = Q.transpose() * A.block<3, 3>(i, j).eval() * Q;
}

}  // namespace

std::optional<PlaneShell> in_its_plane(const ShellNodes& nodes)
{
  const Vector3d D = nodes.D.row(0).transpose();
  const Vector3d normal = D.normalized();
  const NodeVectors from_first = nodes.x.rowwise() - nodes.x.row(0);
  const double size = from_first.cwiseAbs().maxCoeff();
  if ((nodes.D.rowwise() - D.transpose()).cwiseAbs().maxCoeff() > plane * D.norm()) return {};
  if ((from_first * normal).cwiseAbs().maxCoeff() > plane * size) return {};
  Index axis = 0;  // the one nearest to the plane
  normal.cwiseAbs().minCoeff(&axis);
  const Vector3d e = Vector3d::Unit(axis);
  const Vector3d t_1 = (e - e.dot(normal) * normal).normalized();
  PlaneShell shell{.x = {}, .thickness = 2.0 * D.norm(), .Q = {}};
  shell.Q << t_1.transpose(), normal.cross(t_1).transpose(), normal.transpose();
  shell.x = from_first * shell.Q.topRows<2>().transpose();
  return shell;
}

ElementMatrices plane_matrices(int order, const PlaneShell& shell, const Material& material,
                               double beta)
{
  ElementMatrices matrices{.K = plane_stiffness(order, shell, material, beta),
                           .M = plane_mass(order, shell, material.density)};
  turn(matrices.K, shell.Q);
  turn(matrices.M, shell.Q);
  return matrices;
}

}  // namespace chladni::plate
