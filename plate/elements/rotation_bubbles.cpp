#include "plate/elements/rotation_bubbles.hpp"
#include "common/eigen_every.hpp"

#include <Eigen/Dense>
#include <vector>

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

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
