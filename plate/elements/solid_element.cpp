// Isoparametric solids by tables: monomials of the space of an element, and the inverse of their
// values at its nodes, give the shape functions of every type.

#include "plate/elements/solid_element.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "plate/elements/interpolation.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixX3d, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

using mesh::Shape;

struct SolidPoints {
  MatrixX3d r;  ///< parent coordinates
  VectorXd weight;
};

/// Values of functions at points and their parent derivatives, [n_points x n].
struct SolidBasis {
  MatrixXd N;
  std::array<MatrixXd, 3> N_r;
};

/// The sum of the exponents above 1.
int superlinear_degree(const std::array<int, 3>& e)
{
  int degree = 0;
  for (const int exponent : e) degree += exponent > 1 ? exponent : 0;
  return degree;
}

bool is_in_space(Shape shape, int p, const std::array<int, 3>& e)
{
  const auto [i, j, k] = e;
  if (shape == Shape::hexahedron) return superlinear_degree(e) <= p;
  if (shape == Shape::tetrahedron) return i + j + k <= p;
  return k < 2 ? i + j <= p : k <= p && i + j <= 1;
}

std::vector<std::array<int, 3>> exponents(Shape shape, int p)
{
  std::vector<std::array<int, 3>> found;
  for (int k = 0; k <= p; ++k)
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i)
        if (is_in_space(shape, p, {i, j, k})) found.push_back({i, j, k});
  return found;
}

/// x^n, or n x^(n - 1).
double power(double x, int n, bool is_slope)
{
  if (!is_slope) return std::pow(x, n);
  return n == 0 ? 0.0 : n * std::pow(x, n - 1);
}

/// @param along  coordinate by which to derive; -1: none
MatrixXd monomials_at(const std::vector<std::array<int, 3>>& exponents, const MatrixX3d& r,
                      int along)
{
  MatrixXd V = MatrixXd::Ones(r.rows(), std::ssize(exponents));
  for (Index q = 0; q < V.rows(); ++q)
    for (Index m = 0; m < V.cols(); ++m)
      for (int c = 0; c < 3; ++c)
        V(q, m) *= power(r(q, c), exponents[std::size_t(m)][std::size_t(c)], c == along);
  return V;
}

MatrixX3d parent_nodes(Shape shape, int order)
{
  const std::vector<std::array<double, 3>> nodes = mesh::solid_nodes(shape, order);
  MatrixX3d r(std::ssize(nodes), 3);
  for (Index i = 0; i < r.rows(); ++i) r.row(i) = Eigen::RowVector3d(nodes[std::size_t(i)].data());
  return r;
}

SolidBasis solid_basis(Shape shape, int order, const MatrixX3d& r)
{
  const auto space = exponents(shape, order);
  const MatrixXd inverse = monomials_at(space, parent_nodes(shape, order), -1).inverse();
  SolidBasis basis{.N = monomials_at(space, r, -1) * inverse, .N_r = {}};
  for (int c = 0; c < 3; ++c) basis.N_r[std::size_t(c)] = monomials_at(space, r, c) * inverse;
  return basis;
}

SolidPoints hexahedron_points(int n)
{
  const GaussRule g = gauss_legendre(n);
  SolidPoints points{.r = MatrixX3d(n * n * n, 3), .weight = VectorXd(n * n * n)};
  Index q = 0;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i, ++q) {
        points.r.row(q) << g.x[i], g.x[j], g.x[k];
        points.weight[q] = g.w[i] * g.w[j] * g.w[k];
      }
    }
  }
  return points;
}

/// 14 points, exact to degree 5.
SolidPoints tetrahedron_points()
{
  SolidPoints points{.r = MatrixX3d(14, 3), .weight = VectorXd(14)};
  Index q = 0;
  const auto add = [&](const std::array<double, 4>& at, double weight) {
    points.r.row(q) << at[0], at[1], at[2];
    points.weight[q++] = weight;
  };
  constexpr std::array<std::array<double, 2>, 2> near_corners{
      {{0.31088591926330060980, 0.018781320953002641800},
       {0.092735250310891226402, 0.012248840519393658257}}};
  for (const auto& [a, weight] : near_corners) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      std::array<double, 4> at{a, a, a, a};
      at[corner] = 1.0 - 3.0 * a;
      add(at, weight);
    }
  }
  constexpr double a = 0.045503704125649649492, b = 0.5 - a;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      std::array<double, 4> at{a, a, a, a};
      at[i] = at[j] = b;
      add(at, 0.0070910034628469110730);
    }
  }
  return points;
}

/// 6 points of a triangle, exact to degree 4, by Gauss 3.
SolidPoints wedge_points()
{
  constexpr std::array<std::array<double, 2>, 2> rings{
      {{0.44594849091596488632, 0.22338158967801146570},
       {0.09157621350977074346, 0.10995174365532186764}}};
  const GaussRule g = gauss_legendre(3);
  SolidPoints points{.r = MatrixX3d(18, 3), .weight = VectorXd(18)};
  Index q = 0;
  for (int k = 0; k < 3; ++k) {
    for (const auto& [a, weight] : rings) {
      for (int corner = 0; corner < 3; ++corner, ++q) {
        points.r.row(q) << (corner == 0 ? 1.0 - 2.0 * a : a), (corner == 1 ? 1.0 - 2.0 * a : a),
            g.x[k];
        points.weight[q] = 0.5 * weight * g.w[k];
      }
    }
  }
  return points;
}

struct SolidRule {
  SolidPoints points;
  SolidBasis basis;
  SolidBasis centre;  ///< at the middle of a hexahedron
};

SolidRule rule_for(Shape shape, int order)
{
  SolidRule rule{.points = shape == Shape::hexahedron    ? hexahedron_points(order + 1)
                           : shape == Shape::tetrahedron ? tetrahedron_points()
                                                         : wedge_points(),
                 .basis = {},
                 .centre = {}};
  rule.basis = solid_basis(shape, order, rule.points.r);
  if (shape == Shape::hexahedron) rule.centre = solid_basis(shape, order, MatrixX3d::Zero(1, 3));
  return rule;
}

/// Computed once for each type.
const SolidRule& solid_rule(Shape shape, int order)
{
  static std::map<std::pair<Shape, int>, SolidRule> cache;
  const std::pair key{shape, order};
  const auto it = cache.find(key);
  return it != cache.end() ? it->second : cache.emplace(key, rule_for(shape, order)).first->second;
}

/// Where stresses are most accurate; without weights but those of Gauss.
SolidPoints stress_points(Shape shape, int order)
{
  if (shape == Shape::hexahedron) return hexahedron_points(order);
  SolidPoints points{.r = MatrixX3d(shape == Shape::tetrahedron ? 4 : 6, 3), .weight = {}};
  if (shape == Shape::tetrahedron) {
    constexpr double a = 0.13819660112501051518;  // (5 - sqrt 5) / 20
    points.r.setConstant(a);
    for (Index c = 0; c < 3; ++c) points.r(c + 1, c) = 1.0 - 3.0 * a;
  } else {
    const GaussRule g = gauss_legendre(2);
    for (Index q = 0; q < 6; ++q) {
      const Index corner = q % 3;
      points.r.row(q) << (corner == 1 ? 4.0 : 1.0) / 6.0, (corner == 2 ? 4.0 : 1.0) / 6.0,
          g.x[q / 3];
    }
  }
  points.weight = VectorXd::Ones(points.r.rows());
  return points;
}

SolidRule stress_rule(Shape shape, int order)
{
  SolidRule rule{.points = stress_points(shape, order), .basis = {}, .centre = {}};
  rule.basis = solid_basis(shape, order, rule.points.r);
  if (shape == Shape::hexahedron) rule.centre = solid_basis(shape, order, MatrixX3d::Zero(1, 3));
  return rule;
}

/// Rows: the derivatives of the position by r, s, t at a point.
Matrix3d jacobian(const SolidBasis& basis, Index q, const NodeVectors& nodes)
{
  Matrix3d J;
  for (int c = 0; c < 3; ++c) J.row(c) = basis.N_r[std::size_t(c)].row(q) * nodes;
  return J;
}

bool has_incompatible_modes(Shape shape, int order)
{
  return shape == Shape::hexahedron && order == 1;
}

/// (1 - r^2), (1 - s^2), (1 - t^2) with the Jacobian of the centre, det J_0 / det J times: constant
/// stresses do no work on them.
Matrix3d incompatible_gradients(const Eigen::RowVector3d& r, const Matrix3d& J_0, double det_J)
{
  const Matrix3d slopes = (-2.0 * r.transpose()).asDiagonal();  // columns: modes
  return J_0.determinant() / det_J * J_0.inverse() * slopes;
}

constexpr Index n_incompatible = 3;

SolidFrame frame_at(const SolidRule& rule, const NodeVectors& nodes, bool has_more)
{
  const Index n = nodes.rows(), n_points = rule.points.weight.size();
  SolidFrame frame{.dV = VectorXd(n_points),
                   .N = rule.basis.N,
                   .x = rule.basis.N * nodes,
                   .gradient = {},
                   .incompatible = has_more ? MatrixXd(1.0 - rule.points.r.array().square())
                                            : MatrixXd(n_points, 0)};
  for (MatrixXd& along : frame.gradient)
    along.resize(n_points, n + (has_more ? n_incompatible : 0));
  const Matrix3d J_0 = has_more ? jacobian(rule.centre, 0, nodes) : Matrix3d::Identity();
  for (Index q = 0; q < n_points; ++q) {
    const Matrix3d J = jacobian(rule.basis, q, nodes);
    const double det_J = J.determinant();
    frame.dV[q] = rule.points.weight[q] * det_J;
    Eigen::Matrix3Xd slopes(3, n);
    for (int c = 0; c < 3; ++c) slopes.row(c) = rule.basis.N_r[std::size_t(c)].row(q);
    const Eigen::Matrix3Xd gradients = J.inverse() * slopes;
    for (Index c = 0; c < 3; ++c) frame.gradient[std::size_t(c)].row(q).head(n) = gradients.row(c);
    if (!has_more) continue;
    const Matrix3d more = incompatible_gradients(rule.points.r.row(q), J_0, det_J);
    for (Index c = 0; c < 3; ++c)
      frame.gradient[std::size_t(c)].row(q).tail<n_incompatible>() = more.row(c);
  }
  return frame;
}

}  // namespace

MatrixXd solid_shapes(Shape shape, int order, const MatrixX3d& r)
{
  return solid_basis(shape, order, r).N;
}

SolidFrame solid_frame(Shape shape, int order, const NodeVectors& nodes)
{
  return frame_at(solid_rule(shape, order), nodes, has_incompatible_modes(shape, order));
}

namespace {

struct LameConstants {
  double lambda, mu;  ///< Pa

  explicit LameConstants(const Material& material)
      : lambda(0.0), mu(material.young / (2.0 * (1.0 + material.poisson)))
  {
    lambda = 2.0 * mu * material.poisson / (1.0 - 2.0 * material.poisson);
  }
};

/// lambda S_ab + mu S_ba + mu (S_xx + S_yy + S_zz) I, S_ab = int N_a N_b^T dV of the derivatives
/// along a and b; rows of each node in turn.
MatrixXd stiffness_of(const SolidFrame& frame, const Material& material)
{
  const auto [lambda, mu] = LameConstants(material);
  const Index n = frame.gradient[0].cols();
  std::array<std::array<MatrixXd, 3>, 3> S;
  for (std::size_t a = 0; a < 3; ++a) {
    const MatrixXd weighted = frame.dV.asDiagonal() * frame.gradient[a];
    for (std::size_t b = 0; b < 3; ++b)
      S[a][b].noalias() = weighted.transpose() * frame.gradient[b];
  }
  const MatrixXd trace = mu * (S[0][0] + S[1][1] + S[2][2]);
  MatrixXd K(3 * n, 3 * n);
  for (Index a = 0; a < 3; ++a) {
    for (Index b = 0; b < 3; ++b) {
      const auto& [S_ab, S_ba] =
          std::tie(S[std::size_t(a)][std::size_t(b)], S[std::size_t(b)][std::size_t(a)]);
      MatrixXd block = lambda * S_ab + mu * S_ba;
      if (a == b) block += trace;
      K(Eigen::seqN(a, n, 3), Eigen::seqN(b, n, 3)) = block;
    }
  }
  return K;
}

/// T = -K_oo^-1 K_oi: the last coordinates, which nothing loads, by the first n_kept.
MatrixXd followers(const MatrixXd& K, Index n_kept)
{
  const Index n_out = K.rows() - n_kept;
  if (n_out == 0) return MatrixXd(0, n_kept);
  return -K.bottomRightCorner(n_out, n_out).ldlt().solve(K.bottomLeftCorner(n_out, n_kept));
}

/// u_c = N_c d at the points, c = x, y, z, with the incompatible modes T d.
std::array<MatrixXd, 3> displacements(const SolidFrame& frame, const MatrixXd& T)
{
  const Index n = frame.N.cols();
  std::array<MatrixXd, 3> N;
  for (Index c = 0; c < 3; ++c) {
    const MatrixXd of_component = T(Eigen::seqN(c, T.rows() / 3, 3), Eigen::all);
    N[std::size_t(c)] = frame.incompatible * of_component;
    N[std::size_t(c)](Eigen::all, Eigen::seqN(c, n, 3)) += frame.N;
  }
  return N;
}

/// sum dm N^T N over the points; one block for all components where only nodes move.
MatrixXd mass_of(const SolidFrame& frame, const MatrixXd& T, double density)
{
  const VectorXd dm = density * frame.dV;
  const Index n = frame.N.cols();
  MatrixXd M = MatrixXd::Zero(3 * n, 3 * n);
  if (T.rows() > 0) {
    for (const MatrixXd& N : displacements(frame, T)) M += N.transpose() * dm.asDiagonal() * N;
    return M;
  }
  const MatrixXd of_component = frame.N.transpose() * dm.asDiagonal() * frame.N;
  for (Index c = 0; c < 3; ++c) M(Eigen::seqN(c, n, 3), Eigen::seqN(c, n, 3)) = of_component;
  return M;
}

/// From three DOFs a node to six.
MatrixXd with_rotations(const MatrixXd& A)
{
  const Index n = A.rows() / 3;
  MatrixXd padded = MatrixXd::Zero(6 * n, 6 * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) padded.block<3, 3>(6 * i, 6 * j) = A.block<3, 3>(3 * i, 3 * j);
  return padded;
}

}  // namespace

ElementMatrices solid_matrices(const SolidFrame& frame, const Material& material)
{
  const Index n = frame.N.cols();
  const MatrixXd K = stiffness_of(frame, material), T = followers(K, 3 * n);
  return {
      .K = with_rotations(K.topLeftCorner(3 * n, 3 * n) + K.topRightCorner(3 * n, T.rows()) * T),
      .M = with_rotations(mass_of(frame, T, material.density))};
}

namespace {

/// The displacements of nodes and, behind them, of the incompatible modes that follow.
/// @return [n x 3]
MatrixXd all_displacements(const SolidFrame& frame, const Material& material, const VectorXd& u_e)
{
  const Index n = frame.N.cols(), n_all = frame.gradient[0].cols();
  MatrixXd u = MatrixXd::Zero(n_all, 3);
  for (Index i = 0; i < n; ++i) u.row(i) = u_e.segment<3>(6 * i).transpose();
  if (n_all == n) return u;
  const VectorXd of_nodes = u.topRows(n).transpose().reshaped();
  const VectorXd out = followers(stiffness_of(frame, material), 3 * n) * of_nodes;
  u.bottomRows(n_all - n) = out.reshaped(3, n_all - n).transpose();
  return u;
}

}  // namespace

MatrixXd solid_geometric_stiffness(const SolidFrame& frame, const Material& material,
                                   const VectorXd& u_e)
{
  const auto [lambda, mu] = LameConstants(material);
  const Index n = frame.N.cols();
  const MatrixXd u = all_displacements(frame, material, u_e);
  std::array<MatrixXd, 3> slopes;  // [n_points x 3] u_b,a
  for (std::size_t a = 0; a < 3; ++a) slopes[a] = frame.gradient[a] * u;
  const VectorXd trace = slopes[0].col(0) + slopes[1].col(1) + slopes[2].col(2);
  MatrixXd along = MatrixXd::Zero(n, n);
  for (Index a = 0; a < 3; ++a) {
    for (Index b = 0; b < 3; ++b) {
      VectorXd sigma = mu * (slopes[std::size_t(a)].col(b) + slopes[std::size_t(b)].col(a));
      if (a == b) sigma += lambda * trace;
      along += frame.gradient[std::size_t(a)].leftCols(n).transpose() *
               frame.dV.cwiseProduct(sigma).asDiagonal() *
               frame.gradient[std::size_t(b)].leftCols(n);
    }
  }
  MatrixXd K = MatrixXd::Zero(6 * n, 6 * n);
  for (Index c = 0; c < 3; ++c) K(Eigen::seqN(c, n, 6), Eigen::seqN(c, n, 6)) = along;
  return K;
}

Index stress_points_of(Shape shape, int order)
{
  return stress_points(shape, order).r.rows();
}

MatrixXd stresses_to_nodes(Shape shape, int order)
{
  const MatrixX3d points = stress_points(shape, order).r;
  const int p = shape == Shape::hexahedron ? order - 1 : 1;
  std::vector<std::array<int, 3>> space;
  for (int k = 0; k <= p; ++k)
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        const int degree = shape == Shape::wedge ? i + j : i + j + k;
        if (shape == Shape::hexahedron || degree <= 1) space.push_back({i, j, k});
      }
  return monomials_at(space, parent_nodes(shape, order), -1) *
         monomials_at(space, points, -1).inverse();
}

VectorXd von_mises(const MatrixXd& stresses)
{
  const auto s = [&](Index c) { return stresses.col(c).array(); };
  return (0.5 * ((s(0) - s(1)).square() + (s(1) - s(2)).square() + (s(2) - s(0)).square()) +
          3.0 * (s(3).square() + s(4).square() + s(5).square()))
      .sqrt();
}

SolidStresses solid_stresses(Shape shape, int order, const NodeVectors& nodes,
                             const Material& material)
{
  const Index n = nodes.rows();
  const bool has_more = has_incompatible_modes(shape, order);
  const SolidFrame frame = frame_at(stress_rule(shape, order), nodes, has_more);
  const Index n_all = frame.gradient[0].cols();
  MatrixXd u = MatrixXd::Identity(3 * n_all, 3 * n);  // of nodes and incompatible modes
  if (has_more) {
    u.bottomRows(3 * n_incompatible) =
        followers(stiffness_of(solid_frame(shape, order, nodes), material), 3 * n);
  }
  const auto [lambda, mu] = LameConstants(material);
  constexpr std::array<std::array<Index, 2>, 6> components{
      {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
  SolidStresses stresses{.x = frame.x, .S = MatrixXd::Zero(6 * frame.x.rows(), 6 * n)};
  for (Index q = 0; q < frame.x.rows(); ++q) {
    MatrixXd sigma = MatrixXd::Zero(6, 3 * n_all);
    for (Index row = 0; row < 6; ++row) {
      const auto [a, b] = components[std::size_t(row)];
      sigma(row, Eigen::seqN(b, n_all, 3)) += mu * frame.gradient[std::size_t(a)].row(q);
      sigma(row, Eigen::seqN(a, n_all, 3)) += mu * frame.gradient[std::size_t(b)].row(q);
      for (Index c = 0; a == b && c < 3; ++c)
        sigma(row, Eigen::seqN(c, n_all, 3)) += lambda * frame.gradient[std::size_t(c)].row(q);
    }
    const MatrixXd of_nodes = sigma * u;
    for (Index c = 0; c < 3; ++c) {
      stresses.S(Eigen::seqN(6 * q, 6), Eigen::seqN(c, n, 6)) =
          of_nodes(Eigen::all, Eigen::seqN(c, n, 3));
    }
  }
  return stresses;
}

MassPoints solid_mass_points(const SolidFrame& frame, const Material& material)
{
  const Index n = frame.N.cols();
  const MatrixXd T = frame.incompatible.cols() == 0
                         ? MatrixXd(0, 3 * n)
                         : followers(stiffness_of(frame, material), 3 * n);
  const std::array<MatrixXd, 3> N = displacements(frame, T);
  MassPoints points{.dm = material.density * frame.dV, .x = frame.x, .N = {}};
  points.N.fill(StrainRows::Zero(frame.dV.size(), 6 * n));
  for (std::size_t c = 0; c < 3; ++c)
    for (Index component = 0; component < 3; ++component) {
      points.N[c](Eigen::all, Eigen::seqN(component, n, 6)) =
          N[c](Eigen::all, Eigen::seqN(component, n, 3));
    }
  return points;
}

namespace {

/// The nodes of a face in its plane: those of the lowest face of a hexahedron or tetrahedron, which
/// turn the other way round.
MatrixX3d face_nodes(Shape shape, int order)
{
  const MatrixX3d all = parent_nodes(shape, order);
  const std::vector<int> places = mesh::solid_faces(shape, order).front();
  MatrixX3d nodes(std::ssize(places), 3);
  for (Index i = 0; i < nodes.rows(); ++i) {
    const auto at = all.row(places[std::size_t(i)]);
    nodes.row(i) << at[1], at[0], 0.0;
  }
  return nodes;
}

FaceRule make_face_rule(int n_nodes, int order)
{
  const bool is_triangle = n_nodes == 3 * order;
  const Shape shape = is_triangle ? Shape::tetrahedron : Shape::hexahedron;
  FaceRule rule{
      .points = gauss_points(is_triangle ? Shape::triangle : Shape::quadrilateral, order + 2),
      .basis = {}};
  std::vector<std::array<int, 3>> space;
  for (const auto& e : exponents(shape, order))
    if (e[2] == 0) space.push_back(e);
  const MatrixXd inverse = monomials_at(space, face_nodes(shape, order), -1).inverse();
  MatrixX3d r = MatrixX3d::Zero(rule.points.size(), 3);
  r.col(0) = rule.points.xi;
  r.col(1) = rule.points.eta;
  rule.basis = {.N = monomials_at(space, r, -1) * inverse,
                .N_xi = monomials_at(space, r, 0) * inverse,
                .N_eta = monomials_at(space, r, 1) * inverse};
  return rule;
}

}  // namespace

const FaceRule& face_rule(int n_nodes, int order)
{
  static std::map<std::pair<int, int>, FaceRule> cache;
  const std::pair key{n_nodes, order};
  const auto it = cache.find(key);
  return it != cache.end() ? it->second
                           : cache.emplace(key, make_face_rule(n_nodes, order)).first->second;
}

void check_solid_exists(Shape shape, int order)
{
  const bool exists = (shape == Shape::hexahedron && order >= 1 && order <= 3) ||
                      ((shape == Shape::tetrahedron || shape == Shape::wedge) && order == 2);
  if (exists) return;
  const char* name = shape == Shape::hexahedron    ? "hexahedra"
                     : shape == Shape::tetrahedron ? "tetrahedra"
                                                   : "wedges";
  throw Error(fmt::format(
      "there is no solid element of order {} for {}: there are hexahedra of order 1 to 3, "
      "tetrahedra and wedges of order 2",
      order, name));
}

}  // namespace chladni::plate
