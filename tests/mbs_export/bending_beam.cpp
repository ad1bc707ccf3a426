#include "bending_beam.hpp"

#include <algorithm>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::mbs_export::test {
namespace {

using Eigen::Index, Eigen::Matrix4d, Eigen::MatrixXd;

/// Hermite beam element of length l with EI = rho A = 1 in (w_1, theta_1, w_2, theta_2).
struct Element {
  Matrix4d K, M;
};

Element hermite_element(double l)
{
  Element e;
  e.K << 12, 6 * l, -12, 6 * l,             //
      6 * l, 4 * l * l, -6 * l, 2 * l * l,  //
      -12, -6 * l, 12, -6 * l,              //
      6 * l, 2 * l * l, -6 * l, 4 * l * l;
  e.M << 156, 22 * l, 54, -13 * l,            //
      22 * l, 4 * l * l, 13 * l, -3 * l * l,  //
      54, 13 * l, 156, -22 * l,               //
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;
  e.K /= l * l * l;
  e.M *= l / 420;
  // theta_y = -w'
  const Eigen::Vector4d sign(1, -1, 1, -1);
  e.K = sign.asDiagonal() * e.K * sign.asDiagonal();
  e.M = sign.asDiagonal() * e.M * sign.asDiagonal();
  return e;
}

AttachmentNode node_at(int number, double x)
{
  return {number, Eigen::Vector3d(x, 0, 0)};
}

}  // namespace

BendingBeam bending_beam(int n_elements)
{
  const Index n = 2 * (n_elements + 1);
  BendingBeam beam{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  const Element e = hermite_element(1.0 / n_elements);
  for (int i = 0; i < n_elements; ++i) {
    beam.K.block<4, 4>(2 * i, 2 * i) += e.K;
    beam.M.block<4, 4>(2 * i, 2 * i) += e.M;
  }
  return beam;
}

ReducedSystem reduced_beam(int n_elements, int n_modes)
{
  const auto [K, M] = bending_beam(n_elements);
  const int B = 2 * (n_elements / 3), C = 2 * n_elements;
  const std::vector<int> m{0, 1, B, B + 1, C, C + 1};
  std::vector<int> s;
  for (int i = 0; i < K.rows(); ++i)
    if (std::ranges::find(m, i) == m.end()) s.push_back(i);
  const MatrixXd K_ss = K(s, s), M_ss = M(s, s);
  const MatrixXd Psi = -Eigen::LLT<MatrixXd>(K_ss).solve(MatrixXd(K(s, m)));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(M_ss, K_ss);
  const Eigen::VectorXd mu = modes.eigenvalues().reverse().head(n_modes);
  const MatrixXd Phi = modes.eigenvectors().rowwise().reverse().leftCols(n_modes) *
                       mu.cwiseSqrt().cwiseInverse().asDiagonal();
  const MatrixXd P = Phi.transpose() * (M_ss * Psi + M(s, m));
  const Index n_m = Index(m.size()), n = n_m + n_modes;
  ReducedSystem reduced{.title = "bending beam",
                        .attachment_nodes = {node_at(1, 0.0), node_at(n_elements / 3 + 1, 1.0 / 3),
                                             node_at(n_elements + 1, 1.0)},
                        .sets = {{"A", {0}}, {"B", {1}}, {"C", {2}}},
                        .masters = {{0, 2}, {0, 4}, {1, 2}, {1, 4}, {2, 2}, {2, 4}},
                        .K = MatrixXd::Zero(n, n),
                        .M = MatrixXd::Identity(n, n),
                        .C = {},
                        .fixed_interface_frequencies = mu.cwiseInverse().cwiseSqrt(),
                        .picture = {},
                        .provenance = {}};
  const MatrixXd K_G = K(m, m) + K(m, s) * Psi;
  const MatrixXd M_G = M(m, m) + M(m, s) * Psi + Psi.transpose() * (M(s, m) + M_ss * Psi);
  reduced.K.topLeftCorner(n_m, n_m) = 0.5 * (K_G + K_G.transpose());
  reduced.K.diagonal().tail(n_modes) = mu.cwiseInverse();
  reduced.M.topLeftCorner(n_m, n_m) = 0.5 * (M_G + M_G.transpose());
  reduced.M.bottomLeftCorner(n_modes, n_m) = P;
  reduced.M.topRightCorner(n_m, n_modes) = P.transpose();
  return reduced;
}

const ReducedSystem& regression_beam()
{
  static const ReducedSystem reduced = reduced_beam(300, 100);
  return reduced;
}

}  // namespace chladni::mbs_export::test
