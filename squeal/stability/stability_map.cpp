#include "squeal/stability/stability_map.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using Eigen::ArrayXXd, Eigen::Index;
using std::numbers::pi;

namespace {

void fill_column(StabilityMap& map, const Brake& brake, MapParameter parameter, Eigen::Index j)
{
  const auto A = [&](Eigen::Index i) {
    return brake.with(parameter, map.values[i])->state_matrix(map.speeds[j]);
  };
  const Eigen::VectorXcd lambda = least_stable_eigenvalues(A, map.values.size()).lambda;
  map.growth.col(j) = lambda.real();
  map.frequency_Hz.col(j) = lambda.imag() / (2.0 * pi);
}

}  // namespace

StabilityMap empty_map(const MapCase& range, const SpeedRange& speeds)
{
  return {.parameter = key_of(range.parameter),
          .values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to),
          .speeds = Eigen::VectorXd::LinSpaced(speeds.count, speeds.from, speeds.to),
          .growth = Eigen::MatrixXd(range.count, speeds.count),
          .frequency_Hz = Eigen::MatrixXd(range.count, speeds.count)};
}

StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads)
{
  StabilityMap map = empty_map(range, speeds);
  for_each_index(
      speeds.count, [&](int j) { fill_column(map, brake, range.parameter, j); }, n_threads);
  return map;
}

namespace {

using Complex = std::complex<double>;

/// Below these sizes the QR iteration of each matrix takes less time.
constexpr Index smallest_matrix = 24;
constexpr Index shortest_sequence = 8;

/// All eigenvalues with Im > 0 of the last matrices, the latest at the end.
class Branches {
 public:
  void add(Eigen::VectorXcd values)
  {
    if (last_.size() == 4) last_.erase(last_.begin());
    last_.push_back(std::move(values));
  }
  /// By the polynomial through the last values.
  Eigen::VectorXcd next() const
  {
    static constexpr double weights[4][4] = {{1}, {-1, 2}, {1, -3, 3}, {-1, 4, -6, 4}};
    const auto n = last_.size();
    Eigen::VectorXcd value = weights[n - 1][0] * last_[0];
    for (std::size_t i = 1; i < n; ++i) value += weights[n - 1][i] * last_[i];
    return value;
  }

 private:
  std::vector<Eigen::VectorXcd> last_;
};

/// In the eigenvectors of the first matrix, or of another one where these are nearly dependent.
std::optional<LowRankChange> change_over(const MatrixOf& A, Index n)
{
  std::vector<Eigen::MatrixXd> samples;
  for (const Index i : {Index{0}, n - 1, n / 3}) samples.push_back(A(i));
  for (const Eigen::MatrixXd& A_0 : samples)
    if (auto change = LowRankChange::about(A_0, samples)) return change;
  return std::nullopt;
}

class Follower {
 public:
  explicit Follower(const LowRankChange& change) : change_(change) {}

  /// Absent where the QR iteration has to do it.
  std::optional<Complex> follow(const Eigen::MatrixXd& A)
  {
    const std::optional<PoleSum> sum = change_.sum_of(A);
    if (!sum || !known_) return std::nullopt;
    auto found = least_stable_in_discs(*sum, change_.poles(), branches_.next(), A.trace());
    if (!found) return std::nullopt;
    branches_.add(std::move(found->all));
    return found->lambda;
  }

  /// @param all  eigenvalues of the matrix at hand, by the QR iteration
  void learn(const Eigen::VectorXcd& all)
  {
    branches_.add(matched(all, known_ ? branches_.next() : change_.poles()));
    known_ = true;
  }

 private:
  const LowRankChange& change_;
  Branches branches_;
  bool known_ = false;
};

}  // namespace

LeastStableSequence least_stable_eigenvalues(const MatrixOf& A, Index n)
{
  LeastStableSequence sequence{.lambda = Eigen::VectorXcd(n), .count = {}};
  std::optional<LowRankChange> change;
  if (n >= shortest_sequence && A(0).rows() >= smallest_matrix) change = change_over(A, n);
  std::optional<Follower> follower;
  if (change) follower.emplace(*change);
  for (Index i = 0; i < n; ++i) {
    const Eigen::MatrixXd A_i = A(i);
    if (follower)
      if (const auto lambda = follower->follow(A_i)) {
        sequence.lambda[i] = *lambda;
        ++sequence.count.by_discs;
        continue;
      }
    const Eigen::VectorXcd all = oscillating_eigenvalues(A_i);
    Index worst = 0;
    all.real().maxCoeff(&worst);
    sequence.lambda[i] = all[worst];
    ++sequence.count.by_qr;
    if (follower) follower->learn(all);
  }
  return sequence;
}

namespace {

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

namespace {

/// Relative to the norm of A_0: what rounding makes of the entries of state matrices, times 100.
constexpr double entry_rounding = 1e-14;

/// Of the eigenvectors of A_0: it multiplies the rounding errors of all eigenvalues.
constexpr double largest_condition = 1e4;

/// Beyond this rank sums of r x r matrices at n / 2 points take longer than the QR iteration, whose
/// time goes with n^3 and that of the sums with n^2 r^2.
Index largest_rank(Index n)
{
  return static_cast<Index>(2.0 * std::sqrt(double(n)));
}

/// Orthonormal columns that span those of all `changes` up to `tolerance`, the largest first;
/// more than `largest_rank` of them say only that there are too many.
Eigen::MatrixXd common_columns(Eigen::MatrixXd changes, double tolerance)
{
  Eigen::MatrixXd U(changes.rows(), 0);
  while (U.cols() <= largest_rank(U.rows())) {
    Index largest = 0;
    if (changes.colwise().norm().maxCoeff(&largest) <= tolerance) break;
    Eigen::VectorXd u = changes.col(largest).normalized();
    u = (u - U * (U.transpose() * u)).normalized();
    changes -= u * (u.transpose() * changes);
    U.conservativeResize(Eigen::NoChange, U.cols() + 1);
    U.rightCols(1) = u;
  }
  return U;
}

Eigen::MatrixXd changes_of(const Eigen::MatrixXd& A_0, const std::vector<Eigen::MatrixXd>& samples)
{
  const Index n = A_0.rows();
  Eigen::MatrixXd changes(n, n * static_cast<Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    changes.middleCols(n * static_cast<Index>(i), n) = samples[i] - A_0;
  return changes;
}

}  // namespace

std::optional<LowRankChange> LowRankChange::about(const Eigen::MatrixXd& A_0,
                                                  const std::vector<Eigen::MatrixXd>& samples)
{
  const Index n = A_0.rows(), m = n / 2;
  LowRankChange change;
  change.A_0_ = A_0;
  change.rounding_ = entry_rounding * A_0.norm();
  change.U_ = common_columns(changes_of(A_0, samples), change.rounding_);
  if (change.U_.cols() == 0 || change.U_.cols() > largest_rank(n)) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A_0);
  if (solver.info() != Eigen::Success || (solver.eigenvalues().imag().array() == 0.0).any())
    return std::nullopt;
  // Columns (p, q) for each pair p +- i q of right eigenvectors.
  const Eigen::MatrixXd& P = solver.pseudoEigenvectors();
  const Eigen::MatrixXd P_inverse = P.partialPivLu().inverse();
  if (!(P.norm() * P_inverse.norm() <= largest_condition * double(n))) return std::nullopt;
  change.poles_ = solver.eigenvalues()(Eigen::seqN(0, m, 2));
  change.re_ = P(every, Eigen::seqN(0, m, 2));
  change.im_ = P(every, Eigen::seqN(1, m, 2));
  const Eigen::MatrixXd q = P_inverse * change.U_;
  change.left_.resize(m, q.cols());
  change.left_.real() = 0.5 * q(Eigen::seqN(0, m, 2), every);
  change.left_.imag() = -0.5 * q(Eigen::seqN(1, m, 2), every);
  return change;
}

std::optional<PoleSum> LowRankChange::sum_of(const Eigen::MatrixXd& A) const
{
  const Eigen::MatrixXd change = A - A_0_;
  const Eigen::MatrixXd Y = U_.transpose() * change;
  if (!((change - U_ * Y).colwise().norm().maxCoeff() <= rounding_)) return std::nullopt;
  const Index m = poles_.size(), r = U_.cols();
  Eigen::MatrixXcd right(r, m);
  right.real() = Y * re_;
  right.imag() = Y * im_;
  const Eigen::VectorXd by_left = left_.rowwise().norm(), by_right = right.colwise().norm();
  const double left_max = by_left.maxCoeff(), right_max = by_right.maxCoeff();
  PoleSum sum{.modes = {}, .poles = {}, .numerators = Eigen::MatrixXd(2 * r * r, m), .rank = r};
  for (Index k = 0; k < m; ++k) {
    if (std::min(by_left[k] * right_max, by_right[k] * left_max) <= rounding_) continue;
    const auto at = static_cast<Index>(sum.modes.size());
    for (Index j = 0; j < r; ++j)
      for (Index i = 0; i < r; ++i) {
        const Complex R = right(i, k) * left_(k, j);
        sum.numerators(j * r + i, at) = 2.0 * R.real();
        sum.numerators(r * r + j * r + i, at) = -2.0 * (R * std::conj(poles_[k])).real();
      }
    sum.modes.push_back(k);
  }
  sum.numerators.conservativeResize(Eigen::NoChange, static_cast<Index>(sum.modes.size()));
  sum.poles = poles_(sum.modes);
  return sum;
}

}  // namespace chladni::squeal
