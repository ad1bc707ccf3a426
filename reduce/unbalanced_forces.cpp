// Bounds of the error of responses over bands of frequencies and damping.
//
// With sigma = Omega^2 / (1 + i eta) the responses are u = F^T (K - sigma M)^-1 F / (1 + i eta).
// What a model with the Ritz pairs (1 / theta_i, u_i) does not balance, r = F - (K - sigma M) Q x,
// vanishes at sigma = 0 and has no part in the modes that the model shares with the body. Hence
//   r(sigma) = sigma sum_i rho_i b_i / (1 - sigma theta_i),  rho_i = M u_i - theta_i K u_i,
// over the Ritz pairs beyond lambda_left_out alone, b_i = u_i^T F with u_i^T K u_i = 1. With
// W = K^(-1/2) r and E = r^T (K - sigma M)^-1 r, whose spectrum begins at lambda_left_out,
//   |E e_j| <= |W^T W e_j| + g |W| |W e_j|,  g = |sigma| / (lambda_left_out - |sigma|).
// W is analytic: on a disc of radius rho about sigma_0 its length is at most that of the sum of its
// Taylor terms, W_n rho^n, and of a geometric series for the rest. Bands are divided until the
// discs that contain them are small beside their distance from the Ritz values.
#include "reduce/unbalanced_forces.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "reduce/support.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

using Complex = std::complex<double>;

/// Ritz vectors of a model, X^T (K + alpha M) X = I, whose eigenvalues lie beyond a limit.
struct RitzVectors {
  MatrixXd X;
  VectorXd theta;  ///< inverse eigenvalues
};

/// Of the coordinates that a load moves, by M x = nu (K + alpha M) x, nu = 1 / (lambda + alpha),
/// which allows for rigid-body motions and for coordinates without mass.
RitzVectors ritz_vectors_beyond(const LoadedModel& of, const MatrixXd& F)
{
  constexpr double apart = 1e-4;  // less than the gap to the modes that the model has
  const double alpha = of.lambda_of_range;
  const double limit = 1.0 / (of.lambda_left_out * (1.0 - apart) + alpha);
  const std::vector<int> free = all_but(of.still, of.model.K.rows());
  const MatrixXd K = of.model.K(free, free), M = of.model.M(free, free);
  MatrixXd all = MatrixXd::Zero(of.model.K.rows(), F.cols());
  all.topRows(F.rows()) = F;
  RitzVectors ritz{.X = MatrixXd::Zero(of.model.K.rows(), K.rows()), .theta = VectorXd(K.rows())};
  Index n = 0;
  for (const std::vector<Index>& set : linear::decoupled_coordinates(K, M)) {
    std::vector<int> rows;
    for (const Index i : set) rows.push_back(free[std::size_t(i)]);
    if (all(rows, every).isZero(0.0)) continue;
    const Eigen::LLT<MatrixXd> B(MatrixXd(K(set, set) + alpha * M(set, set)));
    if (B.info() != Eigen::Success)
      throw Error("responses: a motion of the reduced model has neither stiffness nor mass");
    const MatrixXd half = B.matrixL().solve(MatrixXd(M(set, set)));
    const MatrixXd A = B.matrixL().solve(half.transpose());
    const linear::SymmetricEigen eigen = linear::symmetric_eigen(0.5 * (A + A.transpose()));
    const MatrixXd X = B.matrixU().solve(eigen.vectors);
    for (Index i = 0; i < X.cols() && eigen.values[std::size_t(i)] < limit; ++i, ++n) {
      const double nu = std::max(eigen.values[std::size_t(i)], 0.0);
      ritz.theta[n] = nu / (1.0 - alpha * nu);
      ritz.X(rows, n) = X.col(i);
    }
  }
  ritz.X.conservativeResize(Eigen::NoChange, n);
  ritz.theta.conservativeResize(n);
  return ritz;
}

/// Y with Y^T Y = G, for G positive semidefinite to round-off.
MatrixXd root(const MatrixXd& G)
{
  if (G.size() == 0) return G;
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(G);
  const VectorXd values =
      Eigen::Map<const VectorXd>(eigen.values.data(), std::ssize(eigen.values)).cwiseMax(0.0);
  return values.cwiseSqrt().asDiagonal() * eigen.vectors.transpose();
}

/// Products of a complex matrix [R | I], real part beside imaginary part.
struct Gram {
  MatrixXcd hermitian;  ///< W^H W
  MatrixXcd symmetric;  ///< W^T W
};

Gram gram_of_parts(const MatrixXd& parts)
{
  const Index l = parts.cols() / 2;
  const MatrixXd G = linear::product(parts.transpose(), parts);
  const auto RR = G.topLeftCorner(l, l), RI = G.topRightCorner(l, l), IR = G.bottomLeftCorner(l, l),
             II = G.bottomRightCorner(l, l);
  Gram products{MatrixXcd(l, l), MatrixXcd(l, l)};
  products.hermitian.real() = RR + II;
  products.hermitian.imag() = RI - IR;
  products.symmetric.real() = RR - II;
  products.symmetric.imag() = RI + IR;
  return products;
}

/// An upper bound of |W| that costs little.
double norm_at_most(const MatrixXcd& hermitian)
{
  const MatrixXd size = hermitian.cwiseAbs();
  return std::sqrt(std::min(size.rowwise().sum().maxCoeff(), size.trace()));
}

VectorXd column_lengths(const MatrixXcd& hermitian)
{
  return hermitian.diagonal().real().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

UnbalancedForces::UnbalancedForces(const LoadedModel& of, const MatrixXd& F)
    : lambda_left_out_(of.lambda_left_out)
{
  RitzVectors ritz = ritz_vectors_beyond(of, F);
  gamma_ = MatrixXd(0, F.cols());
  if (ritz.theta.size() == 0) return;  // all modes of the body
  const Index n_q = std::ssize(of.model.omega);
  const MatrixXd P = ritz.X.bottomRows(n_q) * ritz.theta.asDiagonal();
  Y_ = root(of.forms.energy({.elastic = P, .inertia = ritz.X}));
  lengths_ = Y_.colwise().norm();
  gamma_ = (1.0 + of.lambda_of_range * ritz.theta.array()).matrix().asDiagonal() *
           linear::product(ritz.X.topRows(F.rows()).transpose(), F);
  theta_ = std::move(ritz.theta);
}

/// sigma = s / (1 + i eta) for all s and eta of two intervals.
struct UnbalancedForces::Region {
  double s_from, s_to, eta_from, eta_to;

  static Complex at(double s, double eta) { return s / Complex(1.0, eta); }
  std::pair<Region, Region> halves() const
  {
    if (s_to - s_from > s_to * (eta_to - eta_from)) {
      const double s = 0.5 * (s_from + s_to);
      return {{s_from, s, eta_from, eta_to}, {s, s_to, eta_from, eta_to}};
    }
    const double eta = 0.5 * (eta_from + eta_to);
    return {{s_from, s_to, eta_from, eta}, {s_from, s_to, eta, eta_to}};
  }
};

/// |sigma - centre| <= radius, |sigma| <= farthest: the corners of a region are its farthest
/// points.
struct UnbalancedForces::Disc {
  Complex centre;
  double radius, farthest;
  VectorXcd poles;    ///< 1 / (1 - centre theta)
  VectorXd nearness;  ///< radius over the distance from each Ritz value

  Disc(const Region& region, const VectorXd& theta)
      : centre(Region::at(0.5 * (region.s_from + region.s_to),
                          0.5 * (region.eta_from + region.eta_to))),
        radius(0.0),
        farthest(region.s_to)
  {
    for (const double s : {region.s_from, region.s_to})
      for (const double eta : {region.eta_from, region.eta_to})
        radius = std::max(radius, std::abs(Region::at(s, eta) - centre));
    poles = (1.0 - centre * theta.array().cast<Complex>()).inverse();
    nearness = radius * theta.array() * poles.array().abs();
  }
};

/// Y diag(factors) gamma, real part beside imaginary part.
MatrixXd UnbalancedForces::amplitudes(const VectorXcd& factors) const
{
  MatrixXd scaled(gamma_.rows(), 2 * gamma_.cols());
  scaled << factors.real().asDiagonal() * gamma_, factors.imag().asDiagonal() * gamma_;
  return linear::product(Y_, scaled);
}

VectorXd UnbalancedForces::bounds_in(const Disc& disc) const
{
  constexpr double negligible = 1e-2;
  constexpr int most_terms = 30;
  const Gram first = gram_of_parts(amplitudes(disc.centre * disc.poles));
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> eigen(first.hermitian, Eigen::EigenvaluesOnly);
  const double length_0 = std::sqrt(std::max(eigen.eigenvalues().maxCoeff(), 0.0));
  const VectorXd lengths_0 = column_lengths(first.hermitian);
  double length = length_0;
  VectorXd lengths = lengths_0;
  VectorXcd term = disc.radius * disc.poles.array().square();  // rho^n W_n
  for (int n = 1;; ++n) {
    const VectorXd rest = lengths_.array() * term.array().abs() / (1.0 - disc.nearness.array());
    const VectorXd rest_of_columns = gamma_.cwiseAbs().transpose() * rest;
    if (n == most_terms || (rest_of_columns.array() <= negligible * lengths.array()).all()) {
      length += rest.dot(gamma_.rowwise().norm());
      lengths += rest_of_columns;
      break;
    }
    const MatrixXcd hermitian = gram_of_parts(amplitudes(term)).hermitian;
    length += norm_at_most(hermitian);
    lengths += column_lengths(hermitian);
    term.array() *= disc.radius * theta_.array() * disc.poles.array();
  }
  const double g = disc.farthest / (lambda_left_out_ - disc.farthest);
  return first.symmetric.colwise().norm().transpose() + length * lengths - length_0 * lengths_0 +
         g * length * lengths;
}

VectorXd UnbalancedForces::bounds_in(const Region& region, int depth) const
{
  constexpr double near = 0.2;
  constexpr int deepest = 40;
  const Disc disc(region, theta_);
  if (disc.nearness.maxCoeff() <= near) return bounds_in(disc);
  if (depth == deepest)
    return VectorXd::Constant(gamma_.cols(), std::numeric_limits<double>::infinity());
  const auto [one, other] = region.halves();
  return bounds_in(one, depth + 1).cwiseMax(bounds_in(other, depth + 1));
}

VectorXd UnbalancedForces::error_bounds(const DampedBand& band) const
{
  if (theta_.size() == 0) return VectorXd::Zero(gamma_.cols());
  return bounds_in({.s_from = band.from * band.from,
                    .s_to = band.to * band.to,
                    .eta_from = 0.0,
                    .eta_to = band.loss_factor},
                   0);
}

}  // namespace chladni::reduce
