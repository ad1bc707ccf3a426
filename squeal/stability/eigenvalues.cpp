#include "squeal/stability/eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd;

namespace {

using Complex = std::complex<double>;

Eigen::VectorXd speeds_of(const SpeedRange& range, int count)
{
  return Eigen::VectorXd::LinSpaced(count, range.from, range.to);
}

SearchRange search_over(const SpeedRange& speeds)
{
  return {.from = speeds.from, .to = speeds.to, .count = std::max(128, speeds.count)};
}

}  // namespace

Complex least_stable_eigenvalue(const Eigen::MatrixXd& A)
{
  const Eigen::VectorXcd lambda = oscillating_eigenvalues(A);
  Eigen::Index worst = 0;
  lambda.real().maxCoeff(&worst);
  return lambda[worst];
}

EigenPair least_stable_pair(const Eigen::MatrixXd& A)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Complex expected = least_stable_eigenvalue(A);
  Eigen::Index i = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&i);
  return {solver.eigenvalues()[i], solver.eigenvectors().col(i).normalized()};
}

EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = speeds_of(range, range.count);
  Eigen::MatrixXcd lambda;
  for (Eigen::Index i = 0; i < speeds.size(); ++i) {
    const Eigen::VectorXcd now = oscillating_eigenvalues(A(speeds[i]));
    if (i == 0) {
      lambda.resize(speeds.size(), now.size());
      lambda.row(i) = now.reverse().transpose();
      continue;
    }
    const Eigen::VectorXcd before = lambda.row(std::max<Eigen::Index>(i - 2, 0)).transpose();
    const Eigen::VectorXcd last = lambda.row(i - 1).transpose();
    lambda.row(i) = matched(now, 2.0 * last - before).transpose();
  }
  return {speeds, lambda};
}

StabilityProfile stability_over_speed(const StateMatrixAt& A, const SpeedRange& range)
{
  return stability_over(A, search_over(range));
}

StabilityProfile stability_until_critical(const StateMatrixAt& A, const SpeedRange& range)
{
  return stability_until_loss(A, search_over(range));
}

std::optional<CriticalSpeed> critical_speed(const StabilityProfile& profile)
{
  const std::optional<StabilityPoint> lost = first_loss(profile);
  if (!lost) return std::nullopt;
  return CriticalSpeed{lost->value, lost->frequency_Hz, lost->n_newton_steps};
}

namespace {}  // namespace

Eigen::VectorXcd oscillating_eigenvalues(const Eigen::MatrixXd& A)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(A);
  std::vector<Complex> sorted(lambda.begin(), lambda.end());
  std::ranges::sort(sorted, [](const Complex& x, const Complex& y) {
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return Eigen::Map<const Eigen::VectorXcd>(sorted.data(), lambda.size() / 2);
}

Eigen::VectorXcd matched(const Eigen::VectorXcd& values, const Eigen::VectorXcd& expected)
{
  Eigen::MatrixXd distance(values.size(), values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    distance.row(i) = (expected.array() - values[i]).abs().transpose();
  Eigen::VectorXcd ordered(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    Eigen::Index i = 0, j = 0;
    distance.minCoeff(&i, &j);
    ordered[j] = values[i];
    distance.row(i).setConstant(std::numeric_limits<double>::infinity());
    distance.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return ordered;
}

namespace {

struct Pair {
  Complex lambda;
  Eigen::VectorXcd vector;
};

Pair nearest_pair(const Eigen::MatrixXd& A, const Complex& expected)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  Eigen::Index at = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&at);
  return {solver.eigenvalues()[at], solver.eigenvectors().col(at)};
}

}  // namespace

EigenvalueChange::EigenvalueChange(const Eigen::MatrixXd& A, const Complex& expected)
{
  Pair right = nearest_pair(A, expected);
  lambda_ = right.lambda;
  right_ = std::move(right.vector);
  left_ = nearest_pair(A.transpose(), lambda_).vector;
  left_ /= left_.cwiseProduct(right_).sum();
}

namespace {

/// Of norm 1, turned in time so that the largest component is real and positive.
Eigen::VectorXcd normalised(const Eigen::VectorXcd& shape)
{
  Eigen::Index largest = 0;
  const double modulus = shape.cwiseAbs().maxCoeff(&largest);
  return shape * (std::conj(shape[largest]) / (modulus * shape.norm()));
}

}  // namespace

std::vector<Eigen::MatrixXcd> mode_shapes(const InertialDisc& disc, const SquealOptions& options,
                                          const EigenvalueMap& map)
{
  const InertialDisc brake = with_pads(disc, pad_system(options, ring_places(disc)));
  const Eigen::Index n = brake.n_modes();
  std::vector<Eigen::MatrixXcd> shapes(static_cast<std::size_t>(map.speeds.size()));
  for_each_index(static_cast<int>(map.speeds.size()), [&](int i) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(state_matrix(disc, options, map.speeds[i]));
    Eigen::MatrixXcd at_speed(n, map.lambda.cols());
    for (Eigen::Index j = 0; j < map.lambda.cols(); ++j) {
      Eigen::Index nearest = 0;
      (solver.eigenvalues().array() - map.lambda(i, j)).abs().minCoeff(&nearest);
      const Eigen::VectorXcd a = solver.eigenvectors().col(nearest).head(n).cwiseQuotient(
          brake.omega.cast<std::complex<double>>());
      at_speed.col(j) = normalised(brake.R.cast<std::complex<double>>() * a);
    }
    shapes[static_cast<std::size_t>(i)] = at_speed;
  });
  return shapes;
}

namespace {

constexpr Index small_order = 300, block_width = 4;

bool is_in_band(const Complex& lambda, double highest)
{
  return lambda.imag() > 0.0 && lambda.imag() <= highest;
}

/// What the search about i highest / 2 finds.
bool is_near_axis(const Complex& lambda, double highest)
{
  return std::abs(lambda.real()) <= 0.5 * highest;
}

/// Whether some of the band are strongly damped, or grow as fast.
bool has_far_from_axis(const MatrixXd& A, double highest)
{
  const VectorXcd all = linear::real_eigenvalues(A);
  return std::ranges::any_of(all, [&](const Complex& lambda) {
    return is_in_band(lambda, highest) && !is_near_axis(lambda, highest);
  });
}

/// Those of the band, by ascending frequency.
BandModes within_band(const VectorXcd& lambda, const MatrixXcd& X, double highest)
{
  std::vector<Index> kept;
  for (Index i = 0; i < lambda.size(); ++i)
    if (is_in_band(lambda[i], highest)) kept.push_back(i);
  std::ranges::sort(kept, {}, [&](Index i) { return lambda[i].imag(); });
  BandModes modes{lambda(kept), X(every, kept)};
  modes.X.colwise().normalize();
  return modes;
}

BandModes by_qr(const MatrixXd& A, double highest)
{
  const Eigen::EigenSolver<MatrixXd> solver(A);
  return within_band(solver.eigenvalues(), solver.eigenvectors(), highest);
}

/// The same start each time.
MatrixXcd first_block(Index n)
{
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  MatrixXcd V(n, block_width);
  for (Complex& entry : V.reshaped()) entry = {normal(random), normal(random)};
  return V;
}

MatrixXcd orthonormal_columns(const MatrixXcd& V)
{
  return linear::columns_of_Q(Eigen::HouseholderQR<MatrixXcd>(V), V.cols());
}

/// An orthonormal basis of the block Krylov space of (A - sigma)^-1, and (A - sigma)^-1 of it.
class InverseSpace {
 public:
  InverseSpace(const MatrixXd& A, const Complex& sigma)
      : lu_(A.cast<Complex>() - sigma * MatrixXcd::Identity(A.rows(), A.rows())),
        V_(orthonormal_columns(first_block(A.rows()))),
        W_(A.rows(), 0)
  {}

  /// Adds blocks until there are `size` columns with images.
  void grow(Index size)
  {
    while (W_.cols() < size) {
      const MatrixXcd image = lu_.solve(V_.rightCols(block_width));
      W_.conservativeResize(V_.rows(), W_.cols() + block_width);
      W_.rightCols(block_width) = image;
      MatrixXcd next = image;
      for (int twice = 0; twice < 2; ++twice) next -= V_ * (V_.adjoint() * next);
      V_.conservativeResize(V_.rows(), V_.cols() + block_width);
      V_.rightCols(block_width) = orthonormal_columns(next);
    }
  }

  /// The Ritz values theta of the inverse, and their vectors.
  BandModes ritz() const
  {
    const auto V = V_.leftCols(W_.cols());
    const MatrixXcd H = V.adjoint() * W_;
    const Eigen::ComplexEigenSolver<MatrixXcd> solver(H);
    return {solver.eigenvalues(), V * solver.eigenvectors()};
  }

 private:
  Eigen::PartialPivLU<MatrixXcd> lu_;
  MatrixXcd V_, W_;
};

/// The modes of the band near the axis, where the space tells all of them.
std::optional<BandModes> known_modes(const InverseSpace& space, const MatrixXd& A,
                                     const Complex& sigma, double highest)
{
  constexpr double converged = 1e-9;
  // The corners of the band are highest / sqrt(2) away.
  const double radius = 0.71 * highest;
  BandModes ritz = space.ritz();
  ritz.lambda = (sigma + ritz.lambda.array().inverse()).matrix();
  bool is_complete = false;
  std::vector<Index> near;
  for (Index i = 0; i < ritz.lambda.size(); ++i)
    if (std::abs(ritz.lambda[i] - sigma) <= radius)
      near.push_back(i);
    else
      is_complete = true;
  if (!is_complete) return std::nullopt;
  const VectorXcd lambda = ritz.lambda(near);
  MatrixXcd X = ritz.X(every, near);
  X.colwise().normalize();
  const MatrixXcd residuals = A * X - X * lambda.asDiagonal();
  for (Index i = 0; i < lambda.size(); ++i)
    if (residuals.col(i).norm() > converged * std::abs(sigma)) return std::nullopt;
  std::vector<Index> wanted;
  for (Index i = 0; i < lambda.size(); ++i)
    if (is_near_axis(lambda[i], highest)) wanted.push_back(i);
  return within_band(lambda(wanted), X(every, wanted), highest);
}

}  // namespace

BandModes band_modes(const MatrixXd& A, double highest)
{
  const Index n = A.rows();
  if (n <= small_order || has_far_from_axis(A, highest)) return by_qr(A, highest);
  const Complex sigma(0.0, 0.5 * highest);
  InverseSpace space(A, sigma);
  for (Index size = 80; size <= n / 2; size += size / 2) {
    space.grow(size);
    if (std::optional<BandModes> modes = known_modes(space, A, sigma, highest)) return *modes;
  }
  return by_qr(A, highest);
}

}  // namespace chladni::squeal
