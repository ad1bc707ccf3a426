#include "squeal/stability/turning_brake.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::Matrix2d;
using std::numbers::pi;

namespace {

/// Frequencies of a pair may be so far apart, relative.
constexpr double gap_limit = 0.1;
/// The ratio of the singular values of a pair's harmonic, 1 for a pure pair and 0 for two modes of
/// one phase, must be above this.
constexpr double phase_limit = 0.3;
/// Part of the largest coefficient of the shapes below which a harmonic is rounding.
constexpr double harmonic_rounding = 1e-13;

/// Those that are a cosine where W is one, with weights.
std::vector<RingFunction> across_functions(const DiscRing& ring)
{
  std::vector<RingFunction> functions{{&ring.W, 1.0}, {&ring.W_r, 0.1 * ring.radius}};
  if (ring.V_r.cosine.size() > 0) functions.push_back({&ring.V_r, 0.5});
  return functions;
}

/// [cos(n theta), sin(n theta)] B = (f_i, f_j) on the ring where the two modes move most.
Matrix2d harmonic_of_pair(const Disc& disc, int n, std::pair<int, int> modes)
{
  const auto [i, j] = modes;
  Matrix2d largest = Matrix2d::Zero();
  for (const DiscRing& ring : disc.rings)
    for (const auto& [f, scale] : across_functions(ring)) {
      Matrix2d B;
      B << f->cosine(n, i), f->cosine(n, j), f->sine(n, i), f->sine(n, j);
      if (scale * B.norm() > largest.norm()) largest = scale * B;
    }
  return largest;
}

struct Candidate {
  double gap;
  int n;
  std::pair<int, int> modes;
  Matrix2d R;
};

/// All pairs of modes that may be one, nearest first.
std::vector<Candidate> candidates(const Disc& disc)
{
  const std::vector<int> n = nodal_diameters(disc);
  std::vector<Candidate> all;
  for (int i = 0; i < disc.n_modes(); ++i)
    for (int j = i + 1; j < disc.n_modes(); ++j) {
      const int n_i = n[static_cast<std::size_t>(i)];
      const double gap =
          std::abs(disc.omega[i] - disc.omega[j]) / std::max(disc.omega[i], disc.omega[j]);
      if (n_i == 0 || n_i != n[static_cast<std::size_t>(j)] || !(gap < gap_limit)) continue;
      const Eigen::JacobiSVD<Matrix2d> svd(harmonic_of_pair(disc, n_i, {i, j}),
                                           Eigen::ComputeFullU | Eigen::ComputeFullV);
      if (!(svd.singularValues()[1] > phase_limit * svd.singularValues()[0])) continue;
      all.push_back({gap, n_i, {i, j}, svd.matrixV() * svd.matrixU().transpose()});
    }
  std::ranges::stable_sort(all,
                           [](const Candidate& a, const Candidate& b) { return a.gap < b.gap; });
  return all;
}

/// exp(-phi D) M
Eigen::MatrixXd turned_rows(const std::vector<int>& d, Eigen::MatrixXd M, double phi)
{
  for (std::size_t k = 0; k < d.size(); ++k) {
    if (d[k] == 0) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double c = std::cos(d[k] * phi), s = std::sin(d[k] * phi);
    const Eigen::RowVectorXd first = M.row(i);
    M.row(i) = c * first - s * M.row(i + 1);
    M.row(i + 1) = s * first + c * M.row(i + 1);
    ++k;
  }
  return M;
}

}  // namespace

TurningCoordinates nearest_pairs(const Disc& disc)
{
  const Eigen::Index n = disc.n_modes();
  TurningCoordinates chosen{Eigen::MatrixXd::Zero(n, n), {}};
  std::vector<char> taken(static_cast<std::size_t>(n), 0);
  Eigen::Index at = 0;
  for (const Candidate& pair : candidates(disc)) {
    const auto [i, j] = pair.modes;
    if (taken[static_cast<std::size_t>(i)] || taken[static_cast<std::size_t>(j)]) continue;
    taken[static_cast<std::size_t>(i)] = taken[static_cast<std::size_t>(j)] = 1;
    chosen.R.block<1, 2>(i, at) = pair.R.row(0);
    chosen.R.block<1, 2>(j, at) = pair.R.row(1);
    chosen.d.insert(chosen.d.end(), {pair.n, pair.n});
    at += 2;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    if (taken[static_cast<std::size_t>(i)]) continue;
    chosen.R(i, at++) = 1.0;
    chosen.d.push_back(0);
  }
  return chosen;
}

int highest_harmonic(const Disc& disc, const TurningCoordinates& coordinates)
{
  int highest = 0;
  for (const DiscRing& ring : disc.rings)
    for (const auto& [f, scale] : functions_of(ring)) {
      const double limit = harmonic_rounding *
                           std::max(f->cosine.cwiseAbs().maxCoeff(), f->sine.cwiseAbs().maxCoeff());
      for (Eigen::Index k = 0; k < f->cosine.rows(); ++k) {
        if (std::max(f->cosine.row(k).cwiseAbs().maxCoeff(), f->sine.row(k).cwiseAbs().maxCoeff()) >
            limit)
          highest = std::max(highest, static_cast<int>(k));
      }
    }
  const int d = coordinates.d.empty() ? 0 : *std::ranges::max_element(coordinates.d);
  return highest + d;
}

TurningBrake::TurningBrake(const Disc& disc, const TurningCoordinates& coordinates,
                           const SquealOptions& options, double speed)
    : speed_(speed),
      d_(coordinates.d),
      R_(coordinates.R),
      pads_(pad_system(options, ring_places(disc))),
      shapes_(disc)
{
  const Eigen::Index n = disc.n_modes(), m = pads_.n_modes();
  K_ = R_.transpose() * disc.omega.cwiseAbs2().asDiagonal() * R_;
  C_ = R_.transpose() * (disc.C + 2.0 * speed * disc.G) * R_;
  w_.resize(n + m);
  w_ << K_.diagonal().cwiseSqrt(), pads_.omega;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (d_[static_cast<std::size_t>(i)] == 0) continue;
    w_.segment<2>(i).setConstant(std::sqrt(0.5 * K_.block<2, 2>(i, i).trace()));
    ++i;
  }
  contact_ = contact_at_rest(pads_, n + m, speed);
  ContactSeries(disc.compliance, pads_, speed).condense(contact_);
}

Eigen::MatrixXd TurningBrake::turned(const Eigen::MatrixXd& M, double phi) const
{
  return turned_rows(d_, turned_rows(d_, M, phi).transpose(), phi).transpose();
}

void TurningBrake::place_points(double phi)
{
  for (std::size_t i = 0; i < pads_.points.size(); ++i) {
    const PointPair& point = pads_.points[i];
    const Eigen::MatrixXd at_point = turned_rows(d_, R_.transpose() * shapes_.at(point, phi), phi);
    const PairShapes S = pair_shapes(at_point, pads_, point);
    contact_.S.middleCols(S.cols() * static_cast<Eigen::Index>(i), S.cols()) = S;
  }
}

Eigen::MatrixXd TurningBrake::convected(const Eigen::MatrixXd& z) const
{
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(z.rows(), z.cols());
  for (Eigen::Index i = 0; i < R_.rows(); ++i) {
    const int d = d_[static_cast<std::size_t>(i)];
    if (d == 0) continue;
    rate.row(i) = -speed_ * d * z.row(i + 1);
    rate.row(i + 1) = speed_ * d * z.row(i);
    ++i;
  }
  return rate;
}

Eigen::MatrixXd TurningBrake::in_modes(double phi, const Eigen::MatrixXd& z) const
{
  return R_ * turned_rows(d_, z, -phi);
}

Eigen::MatrixXd TurningBrake::times(double phi, const Eigen::MatrixXd& X)
{
  place_points(phi);
  const Eigen::Index n_disc = R_.rows(), n = w_.size(), m = n - n_disc;
  const Eigen::MatrixXd v = X.bottomRows(n), a = w_.cwiseInverse().asDiagonal() * X.topRows(n);
  Eigen::MatrixXd AX(2 * n, X.cols());
  AX.topRows(n) = convected(X.topRows(n)) + w_.asDiagonal() * v;
  auto force = AX.bottomRows(n);
  force = convected(v);
  force.topRows(n_disc) -= turned_rows(
      d_,
      K_ * turned_rows(d_, a.topRows(n_disc), -phi) + C_ * turned_rows(d_, v.topRows(n_disc), -phi),
      phi);
  if (m > 0) {
    force.bottomRows(m) -= pads_.omega.cwiseAbs2().asDiagonal() * a.bottomRows(m);
    force.bottomRows(m) -= pads_.C * v.bottomRows(m);
  }
  const Eigen::MatrixXd& S = contact_.S;
  force += S * (contact_.D_a * (S.transpose() * a) + contact_.D_p * (S.transpose() * v));
  return AX;
}

Eigen::MatrixXd TurningBrake::at(double phi)
{
  place_points(phi);
  const Eigen::Index n_disc = R_.rows(), n = w_.size(), m = n - n_disc;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = K, D = K;
  K.topLeftCorner(n_disc, n_disc) = turned(K_, phi);
  C.topLeftCorner(n_disc, n_disc) = turned(C_, phi);
  K.diagonal().tail(m) = pads_.omega.cwiseAbs2();
  if (m > 0) C.bottomRightCorner(m, m) = pads_.C;
  K.noalias() -= contact_.S * (contact_.D_a * contact_.S.transpose());
  C.noalias() -= contact_.S * (contact_.D_p * contact_.S.transpose());
  for (Eigen::Index i = 0; i < n_disc; ++i) {
    const int d = d_[static_cast<std::size_t>(i)];
    if (d == 0) continue;
    D(i, i + 1) = d;
    D(i + 1, i) = -d;
    ++i;
  }
  const Eigen::MatrixXd w = w_.asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << -speed_ * D, w, -K * w_.cwiseInverse().asDiagonal(), -speed_ * D - C;
  return A;
}

namespace {

using Complex = std::complex<double>;

/// Of the lower half of A at N angles of a rotation.
AngleHarmonics lower_half(TurningBrake& brake, Index N)
{
  AngleSamples samples;
  for (Index s = 0; s < N; ++s) {
    const Eigen::MatrixXd A = brake.at(2.0 * pi * double(s) / double(N));
    const Index n = A.rows() / 2;
    if (s == 0) samples.resize(n * A.cols(), N);
    samples.col(s) = A.bottomRows(n).reshaped().cast<Complex>();
  }
  return harmonics_of(std::move(samples));
}

/// What the harmonics k and -k move an eigenvalue by, the most: by way of another state and back.
double effect(const TurningHarmonics& at, Index k)
{
  const Index m = at.A_0.rows();
  const Eigen::Map<const Eigen::MatrixXcd> C(at.c.col(k).data(), m / 2, m);
  const Eigen::MatrixXcd B = at.left_V * (C * at.V), B_back = at.left_V * (C.conjugate() * at.V);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(m);
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < m; ++i) {
      const double b_2 = std::abs(B(i, j) * B_back(j, i));
      const double d = std::abs(at.lambda[i] - at.lambda[j] - Complex(0.0, double(k) * at.speed));
      const double shift = b_2 < d * d ? b_2 / d : std::sqrt(b_2);
      moved[i] += shift;
      moved[j] += shift;
    }
  return moved.maxCoeff();
}

/// A harmonic of A and its size.
struct Harmonic {
  int k;
  double norm;  ///< 1/s
};

/// By falling norms, without the last ones, whose sum is added to `left` while it is below
/// `budget`.
std::vector<Harmonic> large_harmonics(const AngleHarmonics& c, double budget, double& left)
{
  std::vector<Harmonic> all;
  for (Index k = 1; k < c.cols() / 2; ++k)
    all.push_back({static_cast<int>(k), 2.0 * c.col(k).norm()});
  std::ranges::stable_sort(all,
                           [](const Harmonic& a, const Harmonic& b) { return a.norm > b.norm; });
  while (!all.empty() && left + all.back().norm <= budget) {
    left += all.back().norm;
    all.pop_back();
  }
  return all;
}

/// What leaving out all harmonics that are no multiples of nu does, until it is above `budget`.
double effect_of_others(const TurningHarmonics& at, const std::vector<Harmonic>& all, int nu,
                        double budget)
{
  double sum = 0.0;
  for (const Harmonic& harmonic : all) {
    if (harmonic.k % nu == 0) continue;
    sum += effect(at, harmonic.k);
    if (sum > budget) break;
  }
  return sum;
}

}  // namespace

TurningHarmonics turning_harmonics(TurningBrake brake, double speed, int bound, double budget)
{
  const AngleHarmonics c = lower_half(brake, power_of_two(2 * bound + 2));
  Eigen::MatrixXd A_0 = brake.at(0.0);
  const Index m = A_0.rows(), n = m / 2;
  A_0.bottomRows(n) = c.col(0).real().reshaped(n, m);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A_0);
  const Eigen::MatrixXcd V = solver.eigenvectors();
  const Eigen::MatrixXcd V_inverse = Eigen::PartialPivLU<Eigen::MatrixXcd>(V).inverse();
  TurningHarmonics found{speed, A_0, solver.eigenvalues(), V, V_inverse.rightCols(n), c, 0, 0, 0.0};
  const std::vector<Harmonic> large = large_harmonics(c, 0.5 * budget, found.left);
  for (std::size_t i = 0; i < large.size(); ++i) {
    const int nu = std::gcd(found.nu, large[i].k);
    if (nu == found.nu) continue;
    // The greatest divisor so far leaves out all that follows and is not a multiple of it.
    if (found.nu > 0) {
      const double others = effect_of_others(found, large, found.nu, 0.5 * budget);
      if (others <= 0.5 * budget) {
        found.left += others;
        break;
      }
    }
    found.nu = nu;
  }
  for (const Harmonic& harmonic : large)
    if (harmonic.k % std::max(1, found.nu) == 0)
      found.highest = std::max(found.highest, harmonic.k);
  found.c = c.leftCols(found.highest + 1);
  return found;
}

TurningModes turning_modes(const TurningHarmonics& harmonics, Index N)
{
  const Index m = harmonics.A_0.rows(), n = m / 2;
  const int nu = std::max(1, harmonics.nu), highest = harmonics.highest / nu;
  Eigen::MatrixXcd c(n * m, highest);
  for (int k = 1; k <= highest; ++k) c.col(k - 1) = harmonics.c.col(Index{k} * nu);
  const Eigen::MatrixXd change = samples_of_real(c, N);
  const Eigen::VectorXcd& lambda = harmonics.lambda;
  const Eigen::MatrixXd VP = to_real_pairs(lambda, harmonics.V.adjoint()).adjoint().real();
  const Eigen::MatrixXd left = to_real_pairs(lambda, harmonics.left_V).real();
  TurningModes modes{nu * harmonics.speed, lambda, Eigen::MatrixXd(m * m, N), highest,
                     Eigen::MatrixXcd(m * m, highest)};
  const auto turned = [&](const auto& A) -> Eigen::MatrixXd { return left * (A * VP); };
  for (Index s = 0; s < N; ++s) modes.B.col(s) = turned(change.col(s).reshaped(n, m)).reshaped();
  for (Index k = 0; k < highest; ++k) {
    modes.B_k.col(k).real() = turned(c.col(k).real().reshaped(n, m)).reshaped();
    modes.B_k.col(k).imag() = turned(c.col(k).imag().reshaped(n, m)).reshaped();
  }
  return modes;
}

namespace {

/// The first rows of conjugate pairs.
std::vector<Index> pairs_of(const Eigen::VectorXcd& lambda)
{
  std::vector<Index> first;
  for (Index i = 0; i + 1 < lambda.size(); ++i)
    if (lambda[i].imag() != 0.0) first.push_back(i++);
  return first;
}

}  // namespace

TurningModes adjoint_of(const TurningModes& modes)
{
  // conj(P) = P s with s = -1 for the second of a pair, and B is real.
  const Index m = modes.size(), N = modes.B.cols();
  Eigen::VectorXd s = Eigen::VectorXd::Ones(m);
  for (const Index i : pairs_of(modes.lambda)) s[i + 1] = -1.0;
  TurningModes adjoint = modes;
  for (Index k = 0; k < N; ++k) {
    const Eigen::MatrixXd B = s.asDiagonal() * modes.at((N - k) % N).transpose() * s.asDiagonal();
    adjoint.B.col(k) = B.reshaped();
  }
  for (Index k = 0; k < modes.highest; ++k) {
    const Eigen::MatrixXcd B = s.asDiagonal() * modes.harmonic(k + 1).adjoint() * s.asDiagonal();
    adjoint.B_k.col(k) = B.reshaped();
  }
  return adjoint;
}

Eigen::MatrixXcd from_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd r)
{
  const double half = std::sqrt(0.5);
  const std::vector<Index> pairs = pairs_of(lambda);
  for (Index j = 0; j < r.cols(); ++j)
    for (const Index i : pairs) {
      const Complex a = half * r(i, j), b = half * r(i + 1, j);
      const Complex turned(-b.imag(), b.real());
      r(i, j) = a + turned;
      r(i + 1, j) = a - turned;
    }
  return r;
}

Eigen::MatrixXcd to_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd y)
{
  const double half = std::sqrt(0.5);
  const std::vector<Index> pairs = pairs_of(lambda);
  for (Index j = 0; j < y.cols(); ++j)
    for (const Index i : pairs) {
      const Complex a = half * y(i, j), b = half * y(i + 1, j), between = b - a;
      y(i, j) = a + b;
      y(i + 1, j) = Complex(-between.imag(), between.real());
    }
  return y;
}

namespace {

/// Rows that are transformed at a time: with all columns they stay in a second-level cache.
constexpr Index rows_in_cache = 32;

/// The places of all columns with the bits of their numbers reversed.
std::vector<Index> reversed_bits(Index N)
{
  std::vector<Index> place(static_cast<std::size_t>(N), 0);
  for (std::size_t i = 1, j = 0; i < place.size(); ++i) {
    std::size_t bit = place.size() / 2;
    for (; j & bit; bit /= 2) j ^= bit;
    j ^= bit;
    place[i] = static_cast<Index>(j);
  }
  return place;
}

/// A few rows of all columns, real and imaginary parts apart.
struct Rows {
  using Part = Eigen::Matrix<double, rows_in_cache, Eigen::Dynamic>;
  Part re, im;

  explicit Rows(Index N) : re(Part::Zero(rows_in_cache, N)), im(re) {}

  /// a + factor b and a - factor b in the place of the columns a and b.
  void butterfly(Index a, Index b, Complex factor)
  {
    using Column = Eigen::Array<double, rows_in_cache, 1>;
    const double c = factor.real(), s = factor.imag();
    const Column b_re = c * re.col(b).array() - s * im.col(b).array();
    const Column b_im = c * im.col(b).array() + s * re.col(b).array();
    re.col(b) = re.col(a).array() - b_re;
    im.col(b) = im.col(a).array() - b_im;
    re.col(a).array() += b_re;
    im.col(a).array() += b_im;
  }
};

/// sum_s f_s exp(sign 2 pi i k s / N) for all k at once (Cooley and Tukey), of a few rows at a
/// time.
class Transform {
 public:
  Transform(Index N, double sign) : place_(reversed_bits(N)), factor_(std::max<Index>(N / 2, 1))
  {
    assert(N > 0 && (N & (N - 1)) == 0);
    for (Index k = 0; k < N / 2; ++k)
      factor_[k] = std::polar(1.0, sign * 2.0 * pi * double(k) / double(N));
  }

  Index place(Index s) const { return place_[static_cast<std::size_t>(s)]; }

  /// @param part  column s holds the sample place(s)
  void operator()(Rows& part) const
  {
    const Index N = std::ssize(place_);
    for (Index half = 1; half < N; half *= 2)
      for (Index first = 0; first < N; first += 2 * half)
        for (Index k = 0; k < half; ++k)
          part.butterfly(first + k, first + k + half, factor_[k * (N / (2 * half))]);
  }

 private:
  std::vector<Index> place_;
  Eigen::VectorXcd factor_;
};

Eigen::MatrixXcd transformed(Eigen::MatrixXcd f, double sign)
{
  const Index N = f.cols();
  const Transform transform(N, sign);
  Rows part(N);
  for (Index row = 0; row < f.rows(); row += rows_in_cache) {
    const Index n = std::min(rows_in_cache, f.rows() - row);
    for (Index s = 0; s < N; ++s) {
      const auto from = f.col(transform.place(s)).segment(row, n);
      part.re.col(s).head(n) = from.real();
      part.im.col(s).head(n) = from.imag();
    }
    transform(part);
    for (Index s = 0; s < N; ++s) {
      auto to = f.col(s).segment(row, n);
      to.real() = part.re.col(s).head(n);
      to.imag() = part.im.col(s).head(n);
    }
  }
  return f;
}

}  // namespace

AngleHarmonics harmonics_of(AngleSamples f)
{
  AngleHarmonics c = transformed(std::move(f), -1.0);
  c *= 1.0 / double(c.cols());
  return c;
}

AngleSamples samples_of(AngleHarmonics c)
{
  return transformed(std::move(c), 1.0);
}

Eigen::MatrixXd samples_of_real(const Eigen::MatrixXcd& c, Index N)
{
  const Transform transform(N, 1.0);
  Eigen::MatrixXd f(c.rows(), N);
  Rows part(N);
  for (Index row = 0; row < c.rows(); row += 2 * rows_in_cache) {
    // The series of two rows, f_1 + i f_2, in one.
    const Index n = std::min(rows_in_cache, c.rows() - row);
    const Index n_2 = std::clamp<Index>(c.rows() - row - n, 0, rows_in_cache);
    part.re.setZero();
    part.im.setZero();
    for (Index s = 0; s < N; ++s) {
      const Index k = transform.place(s), order = std::min(k, N - k);
      if (order == 0 || order > c.cols()) continue;
      const double sign = k == order ? 1.0 : -1.0;
      const auto first = c.col(order - 1).segment(row, n);
      const auto second = c.col(order - 1).segment(row + n, n_2);
      part.re.col(s).head(n) = first.real();
      part.im.col(s).head(n) = sign * first.imag();
      part.re.col(s).head(n_2) -= sign * second.imag();
      part.im.col(s).head(n_2) += second.real();
    }
    transform(part);
    f.middleRows(row, n) = part.re.topRows(n);
    f.middleRows(row + n, n_2) = part.im.topRows(n_2);
  }
  return f;
}

Eigen::Index power_of_two(Eigen::Index n)
{
  Eigen::Index power = 1;
  while (power < n) power *= 2;
  return power;
}

}  // namespace chladni::squeal
