#include "squeal/stability/band_modes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "common/eigen_every.hpp"
#include "linear/dense/orthogonal_factor.hpp"
#include "linear/dense/real_eigenvalues.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd;

constexpr Index small = 300, block = 4;

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
  MatrixXcd V(n, block);
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
      const MatrixXcd image = lu_.solve(V_.rightCols(block));
      W_.conservativeResize(V_.rows(), W_.cols() + block);
      W_.rightCols(block) = image;
      MatrixXcd next = image;
      for (int twice = 0; twice < 2; ++twice) next -= V_ * (V_.adjoint() * next);
      V_.conservativeResize(V_.rows(), V_.cols() + block);
      V_.rightCols(block) = orthonormal_columns(next);
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
  if (n <= small || has_far_from_axis(A, highest)) return by_qr(A, highest);
  const Complex sigma(0.0, 0.5 * highest);
  InverseSpace space(A, sigma);
  for (Index size = 80; size <= n / 2; size += size / 2) {
    space.grow(size);
    if (std::optional<BandModes> modes = known_modes(space, A, sigma, highest)) return *modes;
  }
  return by_qr(A, highest);
}

}  // namespace chladni::squeal
