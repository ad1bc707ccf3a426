#include "exact.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/error.hpp"

namespace chladni::strangers {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd dense(const std::vector<Entry>& A, int n)
{
  MatrixXd sum = MatrixXd::Zero(n, n);
  for (const Entry& a : A) sum(a.row, a.column) += a.value;
  return sum;
}

namespace {

constexpr Index most_in_long_double = 320;

template <class Matrix>
Matrix symmetric(const MatrixXd& A)
{
  const Matrix B = A.template cast<typename Matrix::Scalar>();
  return typename Matrix::Scalar(0.5) * (B + B.transpose());
}

Index rank_of_mass(const MatrixXd& M)
{
  constexpr double nothing = 1e-13;  // of a matrix with unit diagonal
  const VectorXd d = M.diagonal();
  const VectorXd scale = (d.array() > 0.0).select(d.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scale.asDiagonal() * M * scale.asDiagonal(),
                                                      Eigen::EigenvaluesOnly);
  return (eigen.eigenvalues().array() > nothing).count();
}

/// The geometric mean of K_ii / M_ii, an eigenvalue somewhere in the middle.
double middle(const MatrixXd& K, const MatrixXd& M)
{
  double sum = 0.0;
  int n = 0;
  for (Index i = 0; i < K.rows(); ++i) {
    if (!(K(i, i) > 0.0) || !(M(i, i) > 0.0)) continue;
    sum += std::log(K(i, i) / M(i, i));
    ++n;
  }
  return n > 0 ? std::exp(sum / n) : 1.0;
}

/// With shift s the error of mu is that of the largest one, and lambda = 1 / mu - s.
template <class Matrix>
Spectrum shifted_spectrum(const MatrixXd& K, const MatrixXd& M, double s, Index n_finite)
{
  using Scalar = typename Matrix::Scalar;
  const Matrix B = symmetric<Matrix>(K) + Scalar(s) * symmetric<Matrix>(M);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> eigen(symmetric<Matrix>(M), B,
                                                               Eigen::EigenvaluesOnly);
  if (eigen.info() != Eigen::Success) throw Error("spectrum: K + s M is not positive definite");
  const Index n = K.rows();
  Spectrum found;
  for (Index i = 0; i < n_finite; ++i) {
    const Scalar mu = eigen.eigenvalues()[n - 1 - i], lambda = Scalar(1) / mu - Scalar(s);
    constexpr double steps = 30.0;  // of rounding
    found.lambda.push_back(static_cast<double>(lambda));
    found.doubt.push_back(static_cast<double>(steps * std::numeric_limits<Scalar>::epsilon() /
                                              (mu * mu * Scalar(s))));
  }
  return found;
}

template <class Matrix>
Spectrum best_spectrum(const MatrixXd& K, const MatrixXd& M, int n_rigid)
{
  const Index n_finite = rank_of_mass(M);
  Spectrum best = shifted_spectrum<Matrix>(K, M, middle(K, M), n_finite);
  if (n_finite <= n_rigid) return best;
  for (const Index at : {Index(n_rigid), (n_rigid + n_finite) / 2}) {
    const double s = best.lambda[at];
    if (!(s > 0.0)) continue;
    const Spectrum other = shifted_spectrum<Matrix>(K, M, s, n_finite);
    for (Index i = 0; i < n_finite; ++i) {
      if (other.doubt[i] >= best.doubt[i]) continue;
      best.lambda[i] = other.lambda[i];
      best.doubt[i] = other.doubt[i];
    }
  }
  return best;
}

}  // namespace

Spectrum spectrum(const MatrixXd& K, const MatrixXd& M, int n_rigid)
{
  if (K.rows() == 0) return {};
  Spectrum found = K.rows() <= most_in_long_double ? best_spectrum<Dense>(K, M, n_rigid)
                                                   : best_spectrum<MatrixXd>(K, M, n_rigid);
  for (int i = 0; i < std::min<int>(n_rigid, static_cast<int>(found.lambda.size())); ++i)
    found.lambda[i] = 0.0;
  return found;
}

Spectrum held_spectrum(const MatrixXd& K, const MatrixXd& M, const std::vector<int>& masters)
{
  std::vector<int> slaves;
  for (int i = 0; i < K.rows(); ++i)
    if (std::ranges::find(masters, i) == masters.end()) slaves.push_back(i);
  return spectrum(K(slaves, slaves), M(slaves, slaves), 0);
}

CountBelow count_below(const Spectrum& spectrum, double sigma)
{
  CountBelow count{0, 0};
  for (std::size_t i = 0; i < spectrum.lambda.size(); ++i) {
    const double slack = spectrum.doubt[i] + 1e-13 * std::abs(sigma);
    count.surely += spectrum.lambda[i] < sigma - slack;
    count.perhaps += spectrum.lambda[i] < sigma + slack;
  }
  return count;
}

}  // namespace chladni::strangers
