#include "plate/elements/assumed_strains.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <map>
#include <vector>

#include "common/eigen_every.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix2d, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::RowVector3d,
    Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// Components (11, 22, 12) of A^T eps A from those of the symmetric tensor eps.
Matrix3d congruence(const Matrix2d& A)
{
  Matrix3d T;
  T << A(0, 0) * A(0, 0), A(1, 0) * A(1, 0), 2.0 * A(0, 0) * A(1, 0),  //
      A(0, 1) * A(0, 1), A(1, 1) * A(1, 1), 2.0 * A(0, 1) * A(1, 1),   //
      A(0, 0) * A(0, 1), A(1, 0) * A(1, 1), A(0, 0) * A(1, 1) + A(1, 0) * A(0, 1);
  return T;
}

/// At each point F_ia = t_i . a_a for an orthonormal tangent frame (t_1, t_2) that follows one
/// direction through the element, and the area element.
struct TangentFrames {
  std::vector<Matrix2d> F;
  Eigen::VectorXd J;
};

TangentFrames tangent_frames(const ShellFrame& frame, const Eigen::VectorXd& weight)
{
  const Eigen::Index n = frame.a_1.rows();
  TangentFrames frames{.F = std::vector<Matrix2d>(n), .J = Eigen::VectorXd(n)};
  std::vector<Vector3d> normal(n);
  Vector3d mean_normal = Vector3d::Zero();
  for (Eigen::Index q = 0; q < n; ++q) {
    const Vector3d area = frame.a_1.row(q).cross(frame.a_2.row(q));
    frames.J[q] = area.norm();
    normal[q] = area / frames.J[q];
    mean_normal += weight[q] * area;
  }
  mean_normal.normalize();
  const Vector3d a_1 = frame.a_1.row(n / 2);
  const Vector3d direction = a_1 - a_1.dot(mean_normal) * mean_normal;
  for (Eigen::Index q = 0; q < n; ++q) {
    const Vector3d t_1 = (direction - direction.dot(normal[q]) * normal[q]).normalized();
    const Vector3d t_2 = normal[q].cross(t_1);
    frames.F[q] << frame.a_1.row(q).dot(t_1), frame.a_2.row(q).dot(t_1), frame.a_1.row(q).dot(t_2),
        frame.a_2.row(q).dot(t_2);
  }
  return frames;
}

}  // namespace

std::array<StrainRows, 3> correct_mean(const std::array<StrainRows, 3>& tied,
                                       const std::array<StrainRows, 3>& compatible,
                                       const ShellFrame& frame, const Eigen::VectorXd& weight)
{
  const TangentFrames frames = tangent_frames(frame, weight);
  const Eigen::Index n_points = tied[0].rows();
  StrainRows mean = StrainRows::Zero(3, tied[0].cols());
  StrainRows difference(3, tied[0].cols());
  for (Eigen::Index q = 0; q < n_points; ++q) {
    for (int r = 0; r < 3; ++r) difference.row(r) = compatible[r].row(q) - tied[r].row(q);
    mean.noalias() += weight[q] * frames.J[q] * congruence(frames.F[q].inverse()) * difference;
  }
  mean /= weight.dot(frames.J);
  std::array<StrainRows, 3> corrected = tied;
  for (Eigen::Index q = 0; q < n_points; ++q) {
    const StrainRows constant = congruence(frames.F[q]) * mean;
    for (int r = 0; r < 3; ++r) corrected[r].row(q) += constant.row(r);
  }
  return corrected;
}

namespace {

/// Tensor-product interpolation from (xi, eta) coordinates of tying points to the Gauss points.
Tying::Component tensor_component(int order, const VectorXd& xi, const VectorXd& eta)
{
  const VectorXd gauss = gauss_legendre(order + 1).x;
  const MatrixXd along_xi = lagrange(xi, gauss);
  const MatrixXd along_eta = lagrange(eta, gauss);
  const Eigen::Index n = gauss.size();
  MatrixXd weights(n * n, xi.size() * eta.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      weights.row(j * n + i) =
          (along_xi.row(i).transpose() * along_eta.row(j)).reshaped().transpose();
    }
  }
  return {.basis = lagrange_basis(mesh::Shape::quadrilateral, order, tensor_points(xi, eta)),
          .weights = weights};
}

Tying make_tying(int order)
{
  const VectorXd reduced = gauss_legendre(order).x;
  const VectorXd full = gauss_legendre(order + 1).x;
  const VectorXd edges = gauss_lobatto(order + 1);
  return {
      .shear = {tensor_component(order, reduced, edges), tensor_component(order, edges, reduced)},
      .membrane = {tensor_component(order, reduced, full), tensor_component(order, full, reduced),
                   tensor_component(order, reduced, reduced)}};
}

}  // namespace

const Tying& quadrilateral_tying(int order)
{
  static std::map<int, Tying> cache;
  const auto it = cache.find(order);
  return it != cache.end() ? it->second : cache.emplace(order, make_tying(order)).first->second;
}

CovariantStrains assume_quadrilateral_strains(int order, const Points& integration,
                                              const ShellNodes& nodes, const ShellFrame& frame,
                                              const CovariantStrains& compatible)
{
  const Tying& tying = quadrilateral_tying(order);
  CovariantStrains assumed = compatible;
  for (std::size_t A = 0; A < 2; ++A) {
    const CovariantStrains tied =
        covariant_strains(tying.shear[A].basis, nodes, StrainParts::shear);
    assumed.g0[A].noalias() = tying.shear[A].weights * tied.g0[A];
    assumed.g1[A].noalias() = tying.shear[A].weights * tied.g1[A];
  }
  if (order == 1) {  // tying at one point would fail the membrane patch test
    assumed.m = assume_bilinear_membrane(integration, nodes);
    return assumed;
  }
  for (std::size_t r = 0; r < 3; ++r) {
    const CovariantStrains tied =
        covariant_strains(tying.membrane[r].basis, nodes, StrainParts::membrane);
    assumed.m[r].noalias() = tying.membrane[r].weights * tied.m[r];
  }
  assumed.m = correct_mean(assumed.m, compatible.m, frame, integration.weight);
  return assumed;
}

namespace {

using PointList = std::vector<std::pair<double, double>>;

Points points_of(const PointList& list)
{
  const auto n = static_cast<Eigen::Index>(list.size());
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    points.xi[i] = list[i].first;
    points.eta[i] = list[i].second;
  }
  return points;
}

/// p Gauss points on each edge: s = 0, r = 0, r + s = 1.
Points edge_points(int p)
{
  const VectorXd gauss = (gauss_legendre(p).x.array() + 1.0) / 2.0;
  PointList list;
  for (const double g : gauss) list.emplace_back(g, 0.0);
  for (const double g : gauss) list.emplace_back(0.0, g);
  for (const double g : gauss) list.emplace_back(g, 1.0 - g);
  return points_of(list);
}

/// Two components at points, of shear strains or of a basis.
struct Components {
  MatrixXd first, second;
};

/// The Nedelec basis of the first kind, order p: P_(p-1)^2 + (s, -r) times the homogeneous
/// polynomials of degree p-1. [n_points x p (p + 2)]
Components nedelec_basis(int p, const Points& points)
{
  const MatrixXd P = monomials(p - 1, points);
  const MatrixXd top = P.rightCols(p);
  const MatrixXd zero = MatrixXd::Zero(P.rows(), P.cols());
  Components basis{.first = MatrixXd(P.rows(), 2 * P.cols() + p),
                   .second = MatrixXd(P.rows(), 2 * P.cols() + p)};
  basis.first << P, zero, points.eta.asDiagonal() * top;
  basis.second << zero, P, -(points.xi.asDiagonal() * top);
  return basis;
}

/// The degrees of freedom of the Nedelec space: the tangential component at the p Gauss points of
/// each edge, and `inner` applied to each component at inner points.
MatrixXd nedelec_values(int p, const Components& on_edges, const MatrixXd& inner,
                        const Components& inside)
{
  MatrixXd values(3 * p + 2 * inner.rows(), inside.first.cols());
  values << on_edges.first.topRows(p), on_edges.second.middleRows(p, p),
      on_edges.first.bottomRows(p) - on_edges.second.bottomRows(p), inner * inside.first,
      inner * inside.second;
  return values;
}

/// Shear at the integration points = weights times the values of `nedelec_values`.
struct ShearTying {
  BubbleBasis edges, inside;  ///< at the points of `nedelec_values`
  MatrixXd inner;             ///< [n x n_inner_points]
  Components weights;
};

/// Inner conditions: the mean at order 2, the values at three points at order 3. Means at order 3
/// make a thick plate stiffer, values at order 2 a thin one softer than it is.
ShearTying make_shear_tying(int order)
{
  constexpr double near = 1.0 / 6.0, far = 4.0 / 6.0;
  const Points integration = gauss_points(mesh::Shape::triangle, order + 1);
  const Points inside =
      order == 2 ? integration : points_of({{near, near}, {far, near}, {near, far}});
  const MatrixXd inner =
      order == 2 ? MatrixXd(integration.weight.transpose()) : MatrixXd(MatrixXd::Identity(3, 3));
  const MatrixXd inverse = nedelec_values(order, nedelec_basis(order, edge_points(order)), inner,
                                          nedelec_basis(order, inside))
                               .inverse();
  const Components at_gauss = nedelec_basis(order, integration);
  return {.edges = basis_with_bubbles(order, edge_points(order)),
          .inside = basis_with_bubbles(order, inside),
          .inner = inner,
          .weights = {.first = at_gauss.first * inverse, .second = at_gauss.second * inverse}};
}

/// Membrane strains at the integration points = weights times the values of `regge_values`.
struct MembraneTying {
  BubbleBasis edges;  ///< at their Gauss points
  MatrixXd moments;   ///< [n x n_integration_points] against the polynomials of degree p-2
  std::array<MatrixXd, 3> weights;
};

/// Strain along each edge at its p Gauss points, then the moments of the three components.
MatrixXd regge_values(int p, const std::array<MatrixXd, 3>& on_edges,
                      const std::array<MatrixXd, 3>& moments)
{
  const auto& [e_11, e_22, e_12] = on_edges;
  const Eigen::Index n = moments[0].rows();
  MatrixXd values(3 * p + 3 * n, e_11.cols());
  values << e_11.topRows(p), e_22.middleRows(p, p),
      e_11.bottomRows(p) + e_22.bottomRows(p) - 2.0 * e_12.bottomRows(p), moments[0], moments[1],
      moments[2];
  return values;
}

/// P for one component, zero for the two others.
std::array<MatrixXd, 3> three_components(const MatrixXd& P)
{
  const MatrixXd zero = MatrixXd::Zero(P.rows(), P.cols());
  std::array<MatrixXd, 3> components;
  for (MatrixXd& component : components) component.resize(P.rows(), 3 * P.cols());
  components[0] << P, zero, zero;
  components[1] << zero, P, zero;
  components[2] << zero, zero, P;
  return components;
}

MembraneTying make_membrane_tying(int p)
{
  const Points integration = gauss_points(mesh::Shape::triangle, p + 1);
  const Points edges = edge_points(p);
  const MatrixXd moments =
      monomials(p - 2, integration).transpose() * integration.weight.asDiagonal();
  const MatrixXd P = monomials(p - 1, integration);
  const MatrixXd inverse =
      regge_values(p, three_components(monomials(p - 1, edges)), three_components(moments * P))
          .inverse();
  MembraneTying tying{.edges = basis_with_bubbles(p, edges), .moments = moments, .weights = {}};
  for (std::size_t r = 0; r < 3; ++r) tying.weights[r] = three_components(P)[r] * inverse;
  return tying;
}

/// `make(order)`, made once for each order.
template <typename TyingOf>
const auto& made_once(int order, TyingOf make)
{
  static std::map<int, decltype(make(order))> cache;
  const auto it = cache.find(order);
  return it != cache.end() ? it->second : cache.emplace(order, make(order)).first->second;
}

}  // namespace

CovariantStrains assume_triangle_shear(int order, const ShellNodes& nodes,
                                       const CovariantStrains& compatible)
{
  const ShearTying& tying = made_once(order, make_shear_tying);
  const CovariantStrains on_edges = strains_with_bubbles(tying.edges, nodes, StrainParts::shear);
  const CovariantStrains inside = strains_with_bubbles(tying.inside, nodes, StrainParts::shear);
  const auto interpolate = [&](const auto& edge_values, const auto& inner_values) {
    const MatrixXd dofs = nedelec_values(order, {edge_values[0], edge_values[1]}, tying.inner,
                                         {inner_values[0], inner_values[1]});
    return std::array<StrainRows, 2>{tying.weights.first * dofs, tying.weights.second * dofs};
  };
  CovariantStrains assumed = compatible;
  assumed.g0 = interpolate(on_edges.g0, inside.g0);
  assumed.g1 = interpolate(on_edges.g1, inside.g1);
  return assumed;
}

CovariantStrains assume_triangle_membrane(int order, const ShellNodes& nodes,
                                          const CovariantStrains& compatible)
{
  const MembraneTying& tying = made_once(order, make_membrane_tying);
  const CovariantStrains tied = strains_with_bubbles(tying.edges, nodes, StrainParts::membrane);
  const MatrixXd values =
      regge_values(order, {tied.m[0], tied.m[1], tied.m[2]},
                   {tying.moments * compatible.m[0], tying.moments * compatible.m[1],
                    tying.moments * compatible.m[2]});
  CovariantStrains assumed = compatible;
  for (std::size_t r = 0; r < 3; ++r) assumed.m[r].noalias() = tying.weights[r] * values;
  return assumed;
}

namespace {

/// How far the diagonals' middles are apart, x_d = (x_1 - x_2 + x_3 - x_4) / 4, in the
/// contravariant frame of the centre.
struct Distortion {
  double c_r, c_s;
};

Distortion distortion(const NodeVectors& x)
{
  const RowVector3d x_r = 0.25 * (-x.row(0) + x.row(1) - x.row(2) + x.row(3));
  const RowVector3d x_s = 0.25 * (-x.row(0) - x.row(1) + x.row(2) + x.row(3));
  const RowVector3d x_d = 0.25 * (x.row(0) - x.row(1) - x.row(2) + x.row(3));
  const RowVector3d area = x_r.cross(x_s);
  const double J = area.squaredNorm();
  return {.c_r = x_d.dot(x_s.cross(area)) / J, .c_s = x_d.dot(area.cross(x_r)) / J};
}

/// A and B: middles of the edges s = 1, -1; C and D: of r = 1, -1; E: the centre.
Points membrane_tying_points()
{
  Points tying{.xi = Eigen::VectorXd(5), .eta = Eigen::VectorXd(5), .weight = {}};
  tying.xi << 0.0, 0.0, 1.0, -1.0, 0.0;
  tying.eta << 1.0, -1.0, 0.0, 0.0, 0.0;
  return tying;
}

}  // namespace

std::array<StrainRows, 3> assume_bilinear_membrane(const Points& integration,
                                                   const ShellNodes& nodes)
{
  static const Basis at_tying =
      lagrange_basis(mesh::Shape::quadrilateral, 1, membrane_tying_points());
  const auto m = covariant_strains(at_tying, nodes, StrainParts::membrane).m;
  const auto e_rr_A = m[0].row(0), e_rr_B = m[0].row(1);
  const auto e_ss_C = m[1].row(2), e_ss_D = m[1].row(3);
  const auto e_rs_E = m[2].row(4);
  const auto [c_r, c_s] = distortion(nodes.x);
  const double d = c_r * c_r + c_s * c_s - 1.0;  // negative for each convex element
  const StrainRows bilinear = (0.5 * c_r * (c_r - 1.0) * e_rr_A + 0.5 * c_r * (c_r + 1.0) * e_rr_B +
                               0.5 * c_s * (c_s - 1.0) * e_ss_C + 0.5 * c_s * (c_s + 1.0) * e_ss_D +
                               2.0 * c_r * c_s * e_rs_E) /
                              d;
  const StrainRows linear_rr = 0.5 * (e_rr_A - e_rr_B);
  const StrainRows linear_ss = 0.5 * (e_ss_C - e_ss_D);
  std::array<StrainRows, 3> assumed;
  assumed.fill(StrainRows(integration.size(), m[0].cols()));
  for (Eigen::Index q = 0; q < integration.size(); ++q) {
    const double r = integration.xi[q];
    const double s = integration.eta[q];
    assumed[0].row(q) = 0.5 * (e_rr_A + e_rr_B) + s * linear_rr + (s * s - 1.0) * bilinear;
    assumed[1].row(q) = 0.5 * (e_ss_C + e_ss_D) + r * linear_ss + (r * r - 1.0) * bilinear;
    assumed[2].row(q) = e_rs_E + 0.5 * r * linear_rr + 0.5 * s * linear_ss + r * s * bilinear;
  }
  return assumed;
}

namespace {

/// A to C, near the corners, and D to F, at the distance 1e-4 from the centre.
Points shear_tying_points()
{
  constexpr double third = 1.0 / 3.0, sixth = 1.0 / 6.0, d = 1e-4;
  Points points{.xi = VectorXd(6), .eta = VectorXd(6), .weight = {}};
  points.xi << sixth, 4.0 * sixth, sixth, third + d, third - 2.0 * d, third + d;
  points.eta << 4.0 * sixth, sixth, sixth, third - 2.0 * d, third + d, third + d;
  return points;
}

/// A constant shear and one that turns about the centre, from its values at `shear_tying_points`.
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

}  // namespace

CovariantStrains linear_triangle_strains(const ShellNodes& nodes, const BubbleBasis& basis,
                                         const Points& points)
{
  static const BubbleBasis at_tying = basis_with_bubbles(1, shear_tying_points());
  CovariantStrains strains = strains_with_bubbles(basis, nodes);
  const CovariantStrains tied = strains_with_bubbles(at_tying, nodes);
  strains.g0 = tied_shear(tied.g0, points);
  strains.g1 = tied_shear(tied.g1, points);
  return strains;
}

namespace {

Basis bubbles(int order, const Points& points)
{
  const Eigen::ArrayXd r = points.xi, s = points.eta;
  const Eigen::ArrayXd b = 27.0 * r * s * (1.0 - r - s);
  const Eigen::ArrayXd b_r = 27.0 * s * (1.0 - 2.0 * r - s);
  const Eigen::ArrayXd b_s = 27.0 * r * (1.0 - r - 2.0 * s);
  if (order < 3) return {.N = b.matrix(), .N_xi = b_r.matrix(), .N_eta = b_s.matrix()};
  const Eigen::ArrayXd f = 3.0 * r - 1.0, g = 3.0 * s - 1.0;
  Basis two{
      .N = MatrixXd(r.size(), 2), .N_xi = MatrixXd(r.size(), 2), .N_eta = MatrixXd(r.size(), 2)};
  two.N << b * f, b * g;
  two.N_xi << b_r * f + 3.0 * b, b_r * g;
  two.N_eta << b_s * f, b_s * g + 3.0 * b;
  return two;
}

MatrixXd side_by_side(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd AB(A.rows(), A.cols() + B.cols());
  AB << A, B;
  return AB;
}

/// The rotations of the bubbles, and how the nodes turn them: K_bb^-1 K_bn.
struct BubbleSolution {
  std::vector<Index> rotations;  ///< DOFs
  MatrixXd K_bn, X;
};

BubbleSolution solve_bubbles(const MatrixXd& K, const ShellNodes& nodes)
{
  const Index n = 6 * nodes.x.rows();
  BubbleSolution bubbles;
  for (Index dof = n; dof < K.rows(); ++dof)
    if (dof % 6 >= 3) bubbles.rotations.push_back(dof);
  MatrixXd K_bb = K(bubbles.rotations, bubbles.rotations);
  const Eigen::Vector3d d = nodes.D.colwise().mean().transpose().normalized();
  const double held = K_bb.trace();
  for (Index i = 0; i < K_bb.rows(); i += 3) K_bb.block<3, 3>(i, i) += held * d * d.transpose();
  bubbles.K_bn = K(bubbles.rotations, Eigen::seqN(0, n));
  bubbles.X = K_bb.llt().solve(bubbles.K_bn);
  return bubbles;
}

}  // namespace

BubbleBasis basis_with_bubbles(int order, const Points& points)
{
  const Basis nodes = lagrange_basis(mesh::Shape::triangle, order, points);
  const Basis inner = bubbles(order, points);
  return {.surface = nodes,
          .field = {.N = side_by_side(nodes.N, inner.N),
                    .N_xi = side_by_side(nodes.N_xi, inner.N_xi),
                    .N_eta = side_by_side(nodes.N_eta, inner.N_eta)}};
}

CovariantStrains strains_with_bubbles(const BubbleBasis& basis, const ShellNodes& nodes,
                                      StrainParts parts)
{
  const Index n_bubbles = basis.field.N.cols() - basis.surface.N.cols();
  NodeVectors D(nodes.D.rows() + n_bubbles, 3);
  D << nodes.D, nodes.D.colwise().mean().replicate(n_bubbles, 1);
  return covariant_strains(basis.field, shell_frame(basis.surface, nodes), D, parts);
}

MatrixXd eliminate_bubbles(const MatrixXd& K, const ShellNodes& nodes)
{
  const Index n = 6 * nodes.x.rows();
  const BubbleSolution bubbles = solve_bubbles(K, nodes);
  const MatrixXd condensed = K.topLeftCorner(n, n) - bubbles.K_bn.transpose() * bubbles.X;
  return 0.5 * (condensed + condensed.transpose());
}

MatrixXd motion_with_bubbles(const MatrixXd& K, const ShellNodes& nodes)
{
  const Index n = 6 * nodes.x.rows();
  const BubbleSolution bubbles = solve_bubbles(K, nodes);
  MatrixXd T = MatrixXd::Zero(K.rows(), n);
  T.topRows(n).setIdentity();
  T(bubbles.rotations, every) = -bubbles.X;
  return T;
}

}  // namespace chladni::plate
