#include "squeal/stability/turning_brake.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Matrix2d;

/// Frequencies of a pair may be so far apart, relative.
constexpr double gap_limit = 0.1;
/// The ratio of the singular values of a pair's harmonic, 1 for a pure pair and 0 for two modes of
/// one phase, must be above this.
constexpr double phase_limit = 0.3;
/// Part of the largest coefficient of the shapes below which a harmonic is rounding.
constexpr double rounding = 1e-13;

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
      const double limit =
          rounding * std::max(f->cosine.cwiseAbs().maxCoeff(), f->sine.cwiseAbs().maxCoeff());
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

Eigen::MatrixXd TurningBrake::at(double phi)
{
  const Eigen::Index n_disc = R_.rows(), n = w_.size(), m = n - n_disc;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = K, D = K;
  K.topLeftCorner(n_disc, n_disc) = turned(K_, phi);
  C.topLeftCorner(n_disc, n_disc) = turned(C_, phi);
  K.diagonal().tail(m) = pads_.omega.cwiseAbs2();
  if (m > 0) C.bottomRightCorner(m, m) = pads_.C;
  for (std::size_t i = 0; i < pads_.points.size(); ++i) {
    const PointPair& point = pads_.points[i];
    const Eigen::MatrixXd at_point = turned_rows(d_, R_.transpose() * shapes_.at(point, phi), phi);
    const PairShapes S = pair_shapes(at_point, pads_, point);
    contact_.S.middleCols(S.cols() * static_cast<Eigen::Index>(i), S.cols()) = S;
  }
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

}  // namespace chladni::squeal
