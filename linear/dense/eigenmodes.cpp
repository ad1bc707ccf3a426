#include "linear/dense/eigenmodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/deflated_factor.hpp"
#include "linear/dense/part_modes.hpp"

namespace chladni::linear {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// L^-1 M L^-T without the directions L^T R of the zero-energy vectors.
struct Deflated {
  MatrixXd A;
  double size;  ///< of what it was before, which round-off in A is relative to
};

Deflated deflated(const MatrixXd& L, const MatrixXd& M, const MatrixXd& R)
{
  const auto lower = L.triangularView<Eigen::Lower>();
  const MatrixXd half = lower.solve(M);
  MatrixXd A = lower.solve(half.transpose());
  const double size = A.diagonal().cwiseAbs().maxCoeff();
  if (R.cols() > 0) {
    const MatrixXd LtR = L.transpose() * R;
    const MatrixXd Y_r = Eigen::LLT<MatrixXd>(MatrixXd(LtR.transpose() * LtR))
                             .matrixL()
                             .solve(LtR.transpose())
                             .transpose();
    A -= Y_r * (Y_r.transpose() * A);
    A -= (A * Y_r) * Y_r.transpose();
  }
  return {0.5 * (A + A.transpose()), size};
}

/// X made M-orthonormal and M-orthogonal to R, low modes first: round-off leaves a high mode with a
/// share eps lambda_max / lambda_min of low ones.
MatrixXd orthonormalized(const MatrixXd& X, const MatrixXd& M, const MatrixXd& R)
{
  const MatrixXd X_0 = X - R * (R.transpose() * M * X);
  const Eigen::LLT<MatrixXd> MX(MatrixXd(X_0.transpose() * M * X_0));
  return MX.matrixL().solve(X_0.transpose()).transpose();
}

/// The modes X, x^T M x = 1, without those of more than a thousand times the first frequency whose
/// mass is round-off of its parts |x|^T |M| |x|: the rotation of a shell about its normal, of which
/// the mass is what the other modes leave of it.
/// @param mu  relative to that of the first frequency
std::vector<Index> with_mass(const MatrixXd& X, const MatrixXd& M, const VectorXd& mu,
                             double largest_rounding)
{
  constexpr double far = 1e-6;
  const VectorXd parts =
      (X.cwiseAbs().array() * (M.cwiseAbs() * X.cwiseAbs()).array()).colwise().sum();
  std::vector<Index> massive;
  for (Index j = 0; j < X.cols(); ++j) {
    const bool is_round_off = std::numeric_limits<double>::epsilon() * parts[j] > largest_rounding;
    if (!is_round_off || mu[j] > far) massive.push_back(j);
  }
  return massive;
}

/// Coordinates, and the zero-energy vectors that move them.
struct Coordinates {
  std::vector<Index> rows, motions;
};

Coordinates all_coordinates(const MatrixXd& R)
{
  Coordinates all{.rows = std::vector<Index>(static_cast<std::size_t>(R.rows())),
                  .motions = std::vector<Index>(static_cast<std::size_t>(R.cols()))};
  std::iota(all.rows.begin(), all.rows.end(), Index{0});
  std::iota(all.motions.begin(), all.motions.end(), Index{0});
  return all;
}

/// Those that are coupled to no others; all together where a zero-energy vector moves several.
std::vector<Coordinates> decoupled(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  std::vector<Coordinates> parts;
  std::size_t n_motions = 0;
  for (std::vector<Index>& rows : decoupled_coordinates(K, M)) {
    Coordinates part{.rows = std::move(rows), .motions = {}};
    for (Index j = 0; j < R.cols(); ++j)
      if (!R(part.rows, j).isZero(0.0)) part.motions.push_back(j);
    n_motions += part.motions.size();
    parts.push_back(std::move(part));
  }
  if (std::cmp_greater(n_motions, R.cols())) return {all_coordinates(R)};
  return parts;
}

/// The problem of coordinates that are coupled to no others, M x = mu K x, solved: L^T x = y with
/// L L^T = K, deflated as that of all coordinates: a part may have no other motion than a rigid
/// one.
struct SolvedPart {
  std::vector<Index> coordinates;
  MatrixXd M, R, L;
  VectorXd mu;  ///< descending
  MatrixXd Y;   ///< of all mu
  double size;  ///< which round-off in mu is relative to
};

SolvedPart solved(Coordinates of, const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                  double sigma)
{
  const auto& [rows, motions] = of;
  SolvedPart part{.coordinates = {},
                  .M = M(rows, rows),
                  .R = R(rows, motions),
                  .L = {},
                  .mu = {},
                  .Y = {},
                  .size = 0.0};
  const Eigen::LLT<MatrixXd> B = deflated_factor(K(rows, rows), part.M, part.R, sigma);
  part.L = B.matrixL();
  const auto [A, size] = deflated(part.L, part.M, part.R);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  part.mu = solver.eigenvalues().reverse();
  part.Y = solver.eigenvectors().rowwise().reverse();
  part.size = std::max(part.mu[0], size);
  part.coordinates = std::move(of.rows);
  return part;
}

/// What the modes of a part are measured by: values of the whole.
struct Scale {
  double round_off, largest_mu, orthonormal_to;
};

/// The modes of a part, in its coordinates.
Eigenmodes modes_of(const SolvedPart& part, const Scale& of)
{
  const Index n = part.M.rows(), r = part.R.cols();
  if (part.mu[n - 1] < -of.round_off)
    throw Error("eigenmodes: the mass matrix is not positive semidefinite");
  const Index k = std::min<Index>(n - r, (part.mu.array() > of.round_off).count());
  if (k == 0) return {VectorXd(0), MatrixXd(n, 0), static_cast<int>(n - r)};
  const auto mu = part.mu.head(k);
  MatrixXd X = part.L.transpose().triangularView<Eigen::Upper>().solve(part.Y.leftCols(k));
  X.array().rowwise() /= mu.array().sqrt().transpose();
  const std::vector<Index> massive = with_mass(X, part.M, mu / of.largest_mu, of.orthonormal_to);
  const VectorXd lambda = mu(massive).cwiseInverse();
  return {lambda, orthonormalized(X(every, massive), part.M, part.R),
          static_cast<int>(n - r - lambda.size())};
}

}  // namespace

Eigenmodes merged(const std::vector<PartModes>& parts, Index n)
{
  std::vector<std::pair<double, Index>> order;  // lambda, column of all parts side by side
  int n_massless = 0;
  for (const PartModes& part : parts) {
    for (const double lambda : part.modes.lambda)
      order.emplace_back(lambda, static_cast<Index>(order.size()));
    n_massless += part.modes.n_massless;
  }
  MatrixXd X = MatrixXd::Zero(n, std::ssize(order));
  Index first = 0;
  for (const PartModes& part : parts) {
    const Index k = part.modes.lambda.size();
    X(part.coordinates, Eigen::seqN(first, k)) = part.modes.X;
    first += k;
  }
  if (parts.size() > 1) std::ranges::stable_sort(order, {}, &std::pair<double, Index>::first);
  Eigenmodes all{VectorXd(X.cols()), MatrixXd(n, X.cols()), n_massless};
  for (Index i = 0; i < X.cols(); ++i) {
    const auto [lambda, column] = order[static_cast<std::size_t>(i)];
    all.lambda[i] = lambda;
    all.X.col(i) = X.col(column);
  }
  return all;
}

Eigenmodes eigenmodes_of_part(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                              double mu_of_whole, double orthonormal_to)
{
  const Index n = K.rows(), r = R.cols();
  if (n <= r) return {VectorXd(0), MatrixXd(n, 0), 0};
  const double sigma = deflation_shift(K, M, R);
  std::vector<SolvedPart> parts;
  for (Coordinates& of : decoupled(K, M, R)) parts.push_back(solved(std::move(of), K, M, R, sigma));
  double size = mu_of_whole, largest_mu = mu_of_whole;
  for (const SolvedPart& part : parts) {
    size = std::max(size, part.size);
    largest_mu = std::max(largest_mu, part.mu[0]);
  }
  const Scale scale{
      .round_off = 4.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon() * size,
      .largest_mu = largest_mu,
      .orthonormal_to = orthonormal_to};
  std::vector<PartModes> modes;
  for (const SolvedPart& part : parts)
    modes.push_back({.coordinates = part.coordinates, .modes = modes_of(part, scale)});
  return merged(modes, n);
}

Eigenmodes eigenmodes(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                      double orthonormal_to)
{
  return eigenmodes_of_part(K, M, R, 0.0, orthonormal_to);
}

double first_eigenvalue(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  if (K.rows() <= R.cols()) return 0.0;
  const Eigen::LLT<MatrixXd> B = deflated_factor(K, M, R, deflation_shift(K, M, R));
  constexpr int n_iterations = 30;
  // All coordinates take part, none in a pattern that a mode may have too.
  VectorXd x = VectorXd::NullaryExpr(
      K.rows(), [](Index i) { return std::cos(1.0 + static_cast<double>(i) * std::sqrt(2.0)); });
  double largest = 0.0;  // 1 / lambda, by the quotient of Rayleigh
  for (int i = 0; i < n_iterations; ++i) {
    x -= R * (R.transpose() * (M * x));
    const VectorXd Mx = M * x;
    const double mass = x.dot(Mx);
    if (!(mass > 0.0)) return 0.0;
    x = B.solve(Mx);
    largest = x.dot(Mx) / mass;
    x.normalize();
  }
  return largest > 0.0 ? 1.0 / largest : 0.0;
}

}  // namespace chladni::linear
