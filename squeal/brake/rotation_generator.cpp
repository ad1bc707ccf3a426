#include "squeal/brake/rotation_generator.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;

/// Of the commutation with the stiffness against the motion of the rings, whose mean square is 1.
/// Much less lets modes of like harmonics and other frequencies mix, much more forbids what a mesh
/// without symmetry needs.
constexpr double commutation_weight = 1.0;

constexpr int iterations_max = 2000;
constexpr double iteration_error = 1e-15;

/// What the least squares minimise: S P + P S + weight o S = 2 Q for skew S and Q.
struct SkewProblem {
  MatrixXd P, Q, weight;

  MatrixXd apply(const MatrixXd& S) const
  {
    const MatrixXd SP = S * P;
    return SP - SP.transpose() + weight.cwiseProduct(S);
  }
};

SkewProblem skew_problem(const RingHarmonics& harmonics, const VectorXd& omega)
{
  const Eigen::Index n = omega.size();
  SkewProblem problem{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd(n, n)};
  for (std::size_t d = 0; d < harmonics.c.size(); ++d) {
    // S c / d = i c: else a little of harmonic 35 beside harmonic 1, which 36 vanes bring about and
    // which turns the other way, would weigh more than harmonic 1.
    const double by_d = 1.0 / std::max(1.0, double(d));
    const MatrixXd a = harmonics.c[d].real(), b = -harmonics.c[d].imag();
    problem.P += by_d * by_d * (a * a.transpose() + b * b.transpose());
    problem.Q += double(d) * by_d * by_d * (b * a.transpose() - a * b.transpose());
  }
  const double mean = std::max(problem.P.trace() / double(n), 1e-300);
  problem.P /= mean;
  problem.Q /= mean;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const double ratio = omega[i] / omega[j] - omega[j] / omega[i];
      problem.weight(i, j) = 2.0 * commutation_weight * ratio * ratio;
    }
  return problem;
}

/// Conjugate gradients with the diagonal as preconditioner.
MatrixXd solve(const SkewProblem& problem)
{
  const Eigen::Index n = problem.P.rows();
  const VectorXd p = problem.P.diagonal();
  const MatrixXd diagonal =
      (p.replicate(1, n) + p.transpose().replicate(n, 1) + problem.weight).cwiseMax(1e-14);
  MatrixXd S = MatrixXd::Zero(n, n), r = 2.0 * problem.Q, z = r.cwiseQuotient(diagonal), along = z;
  double rz = r.cwiseProduct(z).sum();
  const double small = iteration_error * iteration_error * rz;
  for (int i = 0; i < iterations_max && rz > small; ++i) {
    const MatrixXd A_along = problem.apply(along);
    const double step = rz / along.cwiseProduct(A_along).sum();
    S += step * along;
    r -= step * A_along;
    z = r.cwiseQuotient(diagonal);
    const double next = r.cwiseProduct(z).sum();
    along = z + (next / rz) * along;
    rz = next;
  }
  return 0.5 * (S - S.transpose());
}

/// The real space that complex columns and their conjugates span: its projector is real.
MatrixXcd real_basis(const MatrixXcd& E)
{
  const MatrixXd projector = (E * E.adjoint()).real();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      MatrixXd(0.5 * (projector + projector.transpose())));
  return solver.eigenvectors().rightCols(E.cols()).cast<Complex>();
}

}  // namespace

VectorXd RingHarmonics::squares() const
{
  return squares_by_harmonic().colwise().sum().transpose();
}

MatrixXd RingHarmonics::squares_by_harmonic() const
{
  MatrixXd all(static_cast<Eigen::Index>(c.size()), c.front().rows());
  for (std::size_t d = 0; d < c.size(); ++d)
    all.row(static_cast<Eigen::Index>(d)) = c[d].cwiseAbs2().rowwise().sum().transpose();
  return all;
}

RingHarmonics ring_harmonics(const std::vector<DiscRing>& rings)
{
  Eigen::Index n_orders = 0;
  const Eigen::Index n_modes = rings.front().W.cosine.cols();
  for (const DiscRing& ring : rings) n_orders = std::max(n_orders, ring.n_whole_harmonics());
  const auto n_columns =
      static_cast<Eigen::Index>(functions_of(rings.front()).size() * rings.size());
  RingHarmonics all{std::vector<MatrixXcd>(static_cast<std::size_t>(n_orders),
                                           MatrixXcd::Zero(n_modes, n_columns))};
  Eigen::Index column = 0;
  for (const DiscRing& ring : rings)
    for (const auto& [f, scale] : functions_of(ring)) {
      for (Eigen::Index d = 0; d < ring.n_whole_harmonics(); ++d) {
        all.c[static_cast<std::size_t>(d)].col(column) =
            scale * (f->cosine.row(d) - Complex(0.0, 1.0) * f->sine.row(d)).transpose();
      }
      ++column;
    }
  return all;
}

MatrixXd rotation_generator(const RingHarmonics& harmonics, const VectorXd& omega)
{
  return solve(skew_problem(harmonics, omega));
}

std::vector<HarmonicSpace> harmonic_spaces(const MatrixXd& S)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(
      MatrixXcd(Complex(0.0, -1.0) * S.cast<Complex>()));
  const VectorXd& sigma = solver.eigenvalues();
  std::vector<HarmonicSpace> spaces;
  for (Eigen::Index first = 0; first < sigma.size();) {
    const long d = std::lround(sigma[first]);
    Eigen::Index last = first;
    while (last < sigma.size() && std::lround(sigma[last]) == d) ++last;
    const MatrixXcd E = solver.eigenvectors().middleCols(first, last - first);
    if (d >= 0) spaces.push_back({static_cast<int>(d), d == 0 ? real_basis(E) : E});
    first = last;
  }
  return spaces;
}

}  // namespace chladni::squeal
