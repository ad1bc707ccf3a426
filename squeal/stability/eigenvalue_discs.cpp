#include "squeal/stability/eigenvalue_discs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::ArrayXXd;
using Eigen::Index;

/// Of the discs that may hold the rightmost eigenvalue, relative to |lambda|. The error of their
/// centres is smaller by the ratio of this radius to the distance of the next eigenvalue.
constexpr double largest_radius = 1e-10;

constexpr int most_sweeps = 8;

/// z moves by this much, relative, where it meets a pole.
constexpr double away_from_pole = 1e-12;

struct ComplexArrays {
  ArrayXXd re, im;
};

/// (z_i - a_k) (z_i - conj(a_k)), [a x z]
ComplexArrays pair_products(const Eigen::VectorXcd& a, const Eigen::VectorXcd& z)
{
  const Index m = a.size(), n = z.size();
  ComplexArrays product{ArrayXXd(m, n), ArrayXXd(m, n)};
  const Eigen::ArrayXd a_re = a.real(), a_im = a.imag();
  for (Index i = 0; i < n; ++i) {
    const double z_re = z[i].real(), z_im = z[i].imag();
    product.re.col(i) = (z_re - a_re).square() - (z_im - a_im) * (z_im + a_im);
    product.im.col(i) = 2.0 * z_im * (z_re - a_re);
  }
  return product;
}

/// Gaussian elimination in place.
Complex determinant(Eigen::MatrixXcd& N)
{
  const Index r = N.rows();
  Complex det = 1.0;
  for (Index k = 0; k < r; ++k) {
    Index pivot = k;
    for (Index i = k + 1; i < r; ++i)
      if (std::norm(N(i, k)) > std::norm(N(pivot, k))) pivot = i;
    if (pivot != k) det = -det;
    for (Index j = k; pivot != k && j < r; ++j) std::swap(N(k, j), N(pivot, j));
    det *= N(k, k);
    if (det == 0.0) return det;
    for (Index i = k + 1; i < r; ++i) {
      const Complex factor = N(i, k) / N(k, k);
      for (Index j = k + 1; j < r; ++j) N(i, j) -= factor * N(k, j);
    }
  }
  return det;
}

/// det N(z) for each z
Eigen::VectorXcd determinants(const PoleSum& sum, const Eigen::VectorXcd& z)
{
  const Index n = z.size(), r = sum.rank, size = r * r;
  const ComplexArrays q = pair_products(sum.poles, z);
  const ArrayXXd by_square = (q.re.square() + q.im.square()).inverse();
  Eigen::MatrixXd inverse(q.re.rows(), 2 * n);
  inverse.leftCols(n) = q.re * by_square;
  inverse.rightCols(n) = -q.im * by_square;
  const Eigen::MatrixXd S = sum.numerators * inverse;
  Eigen::VectorXcd det(n);
  Eigen::MatrixXcd N(r, r);
  for (Index i = 0; i < n; ++i) {
    for (Index e = 0; e < size; ++e) {
      N.reshaped()[e] =
          (e % (r + 1) == 0 ? 1.0 : 0.0) -
          (z[i] * Complex(S(e, i), S(e, n + i)) + Complex(S(size + e, i), S(size + e, n + i)));
    }
    det[i] = determinant(N);
  }
  return det;
}

/// w_i for det N(z_i)
Eigen::VectorXcd corrections(const Eigen::VectorXcd& poles, const Eigen::VectorXcd& z,
                             const Eigen::VectorXcd& det)
{
  const ComplexArrays q = pair_products(poles, z);
  ComplexArrays s = pair_products(z, z);
  s.re.matrix().diagonal().setZero();
  s.im.matrix().diagonal() = 2.0 * z.imag();  // z_i - conj(z_i)
  const ArrayXXd by_square = (s.re.square() + s.im.square()).inverse();
  const ArrayXXd re = (q.re * s.re + q.im * s.im) * by_square;
  const ArrayXXd im = (q.im * s.re - q.re * s.im) * by_square;
  Eigen::VectorXcd w(z.size());
  for (Index i = 0; i < z.size(); ++i) {
    double x = det[i].real(), y = det[i].imag();
    for (Index k = 0; k < z.size(); ++k) {
      const double x_k = x * re(k, i) - y * im(k, i);
      y = x * im(k, i) + y * re(k, i);
      x = x_k;
    }
    w[i] = {x, y};
  }
  return w;
}

struct Discs {
  Eigen::VectorXcd centre;
  Eigen::VectorXd radius;

  Discs(const Eigen::VectorXcd& z, const Eigen::VectorXcd& w)
      : centre(z - w), radius(double(2 * z.size() - 1) * w.cwiseAbs())
  {}
  double right(Index i) const { return centre[i].real() + radius[i]; }
  bool is_small(Index i) const { return radius[i] <= largest_radius * std::abs(centre[i]); }
};

/// Large discs that may reach beyond the eigenvalue that is certain to be at `from` or to the
/// right.
std::vector<Index> undecided(const Discs& discs, double from)
{
  double certain = from;
  for (Index i = 0; i < discs.radius.size(); ++i)
    if (discs.is_small(i)) certain = std::max(certain, discs.centre[i].real() - discs.radius[i]);
  std::vector<Index> found;
  for (Index i = 0; i < discs.radius.size(); ++i)
    if (!discs.is_small(i) && !(discs.right(i) < certain)) found.push_back(i);
  return found;
}

/// Whether disc i meets none of the others and of their conjugates.
bool is_alone(const Discs& discs, Index i)
{
  for (Index k = 0; k < discs.radius.size(); ++k) {
    const double apart = std::abs(discs.centre[i] - discs.centre[k]);
    const double apart_from_conjugate = std::abs(discs.centre[i] - std::conj(discs.centre[k]));
    const double needed = discs.radius[i] + discs.radius[k];
    if (!(apart_from_conjugate > needed) || (k != i && !(apart > needed))) return false;
  }
  return true;
}

/// Each value or its conjugate: approximations may go to either.
Eigen::VectorXcd in_upper_half(Eigen::VectorXcd z)
{
  for (Complex& x : z)
    if (x.imag() < 0.0) x = std::conj(x);
  return z;
}

/// z, moved a little where it meets a pole.
Eigen::VectorXcd beside_poles(Eigen::VectorXcd z, const Eigen::VectorXcd& poles)
{
  for (Complex& x : z)
    if ((poles.array() - x).abs2().minCoeff() < 0.01 * std::norm(away_from_pole * x))
      x += away_from_pole * std::abs(x);
  return z;
}

/// Discs in which the rightmost eigenvalue is known.
/// @param from  an eigenvalue is known to be there or further right
std::optional<Discs> decided_discs(const PoleSum& sum, Eigen::VectorXcd z, double from)
{
  z = beside_poles(std::move(z), sum.poles);
  Eigen::VectorXcd det = determinants(sum, z);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    const Eigen::VectorXcd w = corrections(sum.poles, z, det);
    if (!w.allFinite()) return std::nullopt;
    const Discs discs(z, w);
    const std::vector<Index> open = undecided(discs, from);
    if (open.empty()) return discs;
    z(open) = beside_poles(discs.centre(open), sum.poles);
    det(open) = determinants(sum, z(open));
  }
  return std::nullopt;
}

/// The sum over the centres is the trace whatever z is: sum w_i = sum z_i - tr A.
bool sum_is(const Eigen::VectorXcd& eigenvalues, double trace, double tolerance)
{
  return std::abs(2.0 * eigenvalues.real().sum() - trace) <= tolerance;
}

Index rightmost(const Eigen::VectorXcd& z)
{
  Index i = 0;
  z.real().maxCoeff(&i);
  return i;
}

}  // namespace

std::optional<LeastStable> least_stable_in_discs(const PoleSum& sum, const Eigen::VectorXcd& poles,
                                                 const Eigen::VectorXcd& start, double trace)
{
  LeastStable found{.lambda = {}, .all = poles};
  if (!sum.modes.empty()) {
    Eigen::VectorXcd left_out = poles;
    left_out(sum.modes).setConstant(-std::numeric_limits<double>::infinity());
    const std::optional<Discs> discs =
        decided_discs(sum, start(sum.modes), left_out.real().maxCoeff());
    if (!discs) return std::nullopt;
    const Index first = rightmost(discs->centre);
    if (discs->centre[first].real() > left_out.real().maxCoeff() && !is_alone(*discs, first))
      return std::nullopt;
    found.all(sum.modes) = in_upper_half(discs->centre);
  }
  found.lambda = found.all[rightmost(found.all)];
  if (!sum_is(found.all, trace, largest_radius * std::abs(found.lambda))) return std::nullopt;
  return found;
}

}  // namespace chladni::squeal
