#include "squeal/brake/inertial_frame.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Matrix2d, std::numbers::pi;

struct Complaint {
  std::string text;  ///< why a disc has no inertial frame, in words for the user
};

/// One mode (n = 0, j = i) or a pair.
struct Group {
  int n, i, j;
};

std::variant<std::vector<Group>, Complaint> group_modes(const Disc& disc)
{
  const std::vector<int> n = nodal_diameters(disc);
  std::vector<Group> groups;
  std::vector<char> taken(n.size(), 0);
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (taken[i]) continue;
    std::size_t j = n[i] > 0 ? i + 1 : i;
    while (n[i] > 0 && j < n.size() && (taken[j] || n[j] != n[i])) ++j;
    if (j == n.size())
      return Complaint{fmt::format(
          "mode {} ({:.1f} Hz) has {} nodal diameters, but no partner among the modes used",
          disc.mode_numbers[i], disc.omega[static_cast<int>(i)] / (2.0 * pi), n[i])};
    taken[i] = taken[j] = 1;
    groups.push_back({n[i], static_cast<int>(i), static_cast<int>(j)});
  }
  return groups;
}

/// [cos(n theta), sin(n theta)] B = (f_i, f_j) for the harmonic n of two modes.
Matrix2d harmonic_of_pair(const Harmonics& f, const Group& group)
{
  Matrix2d B;
  B << f.cosine(group.n, group.i), f.cosine(group.n, group.j), f.sine(group.n, group.i),
      f.sine(group.n, group.j);
  return B;
}

/// What remains of a pair when the harmonic n is taken out, squared.
double other_harmonics(const Harmonics& f, const Group& group)
{
  double sum = 0.0;
  for (const int mode : {group.i, group.j})
    sum += f.cosine.col(mode).squaredNorm() + f.sine.col(mode).squaredNorm();
  return std::max(0.0, sum - harmonic_of_pair(f, group).squaredNorm());
}

/// Amplitudes of a pair on a ring; squares of its motion there and of what is not its harmonic.
struct RingAmplitudes {
  double U, U_r, U_t;
  double whole, rest;
};

/// A pair in its own coordinates (cos, sin): q = R a, its amplitudes on each ring, and how pure it
/// is.
struct PurePair {
  Matrix2d R;
  std::vector<RingAmplitudes> rings;

  double impurity() const
  {
    double rest = 0.0, whole = 0.0;
    for (const RingAmplitudes& ring : rings) {
      rest += ring.rest;
      whole += ring.whole;
    }
    return std::sqrt(std::max(0.0, rest) / whole);
  }
};

/// Of the pair with these coordinates.
RingAmplitudes amplitudes_on(const DiscRing& ring, const Group& group, const Matrix2d& R)
{
  const double r = ring.radius;
  const Matrix2d B = harmonic_of_pair(ring.W, group), B_r = harmonic_of_pair(ring.W_r, group),
                 B_t = harmonic_of_pair(ring.W_t, group);
  const Matrix2d turn{{0.0, 1.0}, {-1.0, 0.0}};  // (cos, sin) turn = (-sin, cos)
  const double U = 0.5 * (B * R).trace(), U_r = 0.5 * (B_r * R).trace(),
               U_t = 0.5 * (turn.transpose() * B_t * R).trace();

  const Matrix2d I = Matrix2d::Identity();
  const double rest =
      (B * R - U * I).squaredNorm() + other_harmonics(ring.W, group) +
      r * r * ((B_r * R - U_r * I).squaredNorm() + other_harmonics(ring.W_r, group)) +
      r * r * ((B_t * R - U_t * turn).squaredNorm() + other_harmonics(ring.W_t, group));
  return {U, U_r, U_t, 2.0 * (U * U + r * r * (U_r * U_r + U_t * U_t)), rest};
}

/// B R = U I for a pure pair; R is the orthogonal polar factor of B, transposed. The shape with the
/// largest motion on any ring gives it, in case a nodal circle lies on one.
PurePair purify(const Disc& disc, const Group& group)
{
  Matrix2d largest = Matrix2d::Zero();
  for (const DiscRing& ring : disc.rings) {
    const Matrix2d B = harmonic_of_pair(ring.W, group),
                   B_r = 0.1 * ring.radius * harmonic_of_pair(ring.W_r, group);
    if (B.norm() > largest.norm()) largest = B;
    if (B_r.norm() > largest.norm()) largest = B_r;
  }
  const Eigen::JacobiSVD<Matrix2d> svd(largest, Eigen::ComputeFullU | Eigen::ComputeFullV);
  PurePair pair{svd.matrixV() * svd.matrixU().transpose(), {}};
  for (const DiscRing& ring : disc.rings) pair.rings.push_back(amplitudes_on(ring, group, pair.R));
  return pair;
}

/// A mode without nodal diameters, as the first of a pair whose second does not exist.
PurePair purify_single(const Disc& disc, const Group& group)
{
  const auto square = [&](const Harmonics& f) {
    return f.cosine.col(group.i).squaredNorm() + f.sine.col(group.i).squaredNorm();
  };
  PurePair pair{Matrix2d::Identity(), {}};
  for (const DiscRing& ring : disc.rings) {
    const double U = ring.W.cosine(0, group.i), U_r = ring.W_r.cosine(0, group.i);
    const double r = ring.radius, whole = U * U + r * r * U_r * U_r;
    const double rest = square(ring.W) + r * r * (square(ring.W_r) + square(ring.W_t)) - whole;
    pair.rings.push_back({U, U_r, 0.0, whole, rest});
  }
  return pair;
}

InertialDisc empty_inertial_disc(const Disc& disc)
{
  const Eigen::Index n = disc.n_modes();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(n, n);
  std::vector<InertialRing> rings;
  for (const DiscRing& ring : disc.rings)
    rings.push_back({ring.name, ring.radius, zero, zero, zero});
  return {.rings = rings,
          .nodal_diameters = std::vector<int>(static_cast<std::size_t>(n), 0),
          .omega = zero,
          .C = zeros,
          .G = zeros,
          .D = zeros,
          .R = zeros,
          .largest_split = 0.0,
          .largest_impurity = 0.0};
}

/// Puts a group at the coordinates `at` (and `at` + 1) of the inertial disc.
InertialDisc with_group(InertialDisc inertial, const Disc& disc, const Group& group, int at)
{
  const int size = group.n == 0 ? 1 : 2;
  const PurePair pair = group.n == 0 ? purify_single(disc, group) : purify(disc, group);
  const double omega = 0.5 * (disc.omega[group.i] + disc.omega[group.j]);
  const int modes[] = {group.i, group.j};
  const auto first = static_cast<std::size_t>(at);
  for (int column = 0; column < size; ++column) {
    for (int row = 0; row < size; ++row) inertial.R(modes[row], at + column) = pair.R(row, column);
    inertial.nodal_diameters[first + column] = group.n;
  }
  inertial.omega.segment(at, size).setConstant(omega);
  for (std::size_t i = 0; i < pair.rings.size(); ++i) {
    inertial.rings[i].U.segment(at, size).setConstant(pair.rings[i].U);
    inertial.rings[i].U_r.segment(at, size).setConstant(pair.rings[i].U_r);
    inertial.rings[i].U_t.segment(at, size).setConstant(pair.rings[i].U_t);
  }
  if (size == 2) inertial.D.block<2, 2>(at, at) << 0.0, group.n, -group.n, 0.0;
  inertial.largest_split =
      std::max(inertial.largest_split, std::abs(disc.omega[group.i] - disc.omega[group.j]) / omega);
  inertial.largest_impurity = std::max(inertial.largest_impurity, pair.impurity());
  return inertial;
}

/// Mean over the circumference of exp(-phi D) C exp(phi D), of damping or Coriolis terms, exact
/// with more than 2 n_max + 1 angles.
Eigen::MatrixXd averaged_over_angles(const InertialDisc& inertial, const Eigen::MatrixXd& C)
{
  const int n_max =
      *std::max_element(inertial.nodal_diameters.begin(), inertial.nodal_diameters.end());
  const int n_angles = 2 * n_max + 2;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(C.rows(), C.cols());
  for (int k = 0; k < n_angles; ++k) {
    const double angle = 2.0 * pi * k / n_angles;
    Eigen::MatrixXd turn = C;
    for (Eigen::Index i = 0; i < C.cols(); ++i) turn.col(i) = turned(inertial, C.col(i), angle);
    const Eigen::MatrixXd half = turn.transpose();
    for (Eigen::Index i = 0; i < C.cols(); ++i)
      mean.row(i) += turned(inertial, half.col(i), angle).transpose() / n_angles;
  }
  return mean;
}

std::variant<InertialDisc, Complaint> try_inertial_disc(const Disc& disc)
{
  const auto groups = group_modes(disc);
  if (const auto* complaint = std::get_if<Complaint>(&groups)) return *complaint;
  InertialDisc inertial = empty_inertial_disc(disc);
  int at = 0;
  for (const Group& group : std::get<0>(groups)) {
    inertial = with_group(std::move(inertial), disc, group, at);
    at += group.n == 0 ? 1 : 2;
  }
  if (!(inertial.largest_impurity < impurity_limit))
    return Complaint{
        fmt::format("its mode shapes on the ring differ from pure harmonics by {:.2g} "
                    "(allowed: {})",
                    inertial.largest_impurity, impurity_limit)};
  if (!(inertial.largest_split < split_limit))
    return Complaint{fmt::format("the frequencies of a pair differ by {:.2g} (allowed: {})",
                                 inertial.largest_split, split_limit)};
  const Eigen::MatrixXd C = inertial.R.transpose() * disc.C * inertial.R;
  inertial.C = averaged_over_angles(inertial, C);
  inertial.G = averaged_over_angles(inertial, inertial.R.transpose() * disc.G * inertial.R);
  const double deviation = (C - inertial.C).norm();
  if (deviation > impurity_limit * C.norm())
    return Complaint{
        fmt::format("its damping changes around the circumference by {:.2g} (allowed: {})",
                    deviation / C.norm(), impurity_limit)};
  return inertial;
}

}  // namespace

InertialDisc inertial_disc(const Disc& disc)
{
  auto outcome = try_inertial_disc(disc);
  if (const auto* complaint = std::get_if<Complaint>(&outcome))
    throw Error(
        fmt::format("the disc is not axisymmetric: {}. Eigenvalues, critical values and limit "
                    "cycles need an axisymmetric disc and both modes of each pair; the analyses "
                    "\"rotation-stability\", \"growth\" and \"transient\" do not",
                    complaint->text));
  return std::get<InertialDisc>(std::move(outcome));
}

std::optional<std::string> asymmetry(const Disc& disc)
{
  const auto outcome = try_inertial_disc(disc);
  const auto* complaint = std::get_if<Complaint>(&outcome);
  return complaint ? std::optional(complaint->text) : std::nullopt;
}

std::optional<InertialDisc> find_inertial_disc(const Disc& disc)
{
  auto outcome = try_inertial_disc(disc);
  auto* inertial = std::get_if<InertialDisc>(&outcome);
  return inertial ? std::optional(std::move(*inertial)) : std::nullopt;
}

Eigen::VectorXd turned(const InertialDisc& disc, const Eigen::VectorXd& a, double angle)
{
  Eigen::VectorXd b = a;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const int n = disc.nodal_diameters[static_cast<std::size_t>(i)];
    if (n == 0) continue;
    const double c = std::cos(n * angle), s = std::sin(n * angle);
    b[i] = c * a[i] - s * a[i + 1];
    b[i + 1] = s * a[i] + c * a[i + 1];
    ++i;
  }
  return b;
}

std::vector<RingPlace> ring_places(const InertialDisc& disc)
{
  std::vector<RingPlace> places;
  for (const auto& ring : disc.rings) places.push_back({ring.name, ring.radius});
  return places;
}

Shapes shapes_at(const InertialDisc& disc, double theta)
{
  return shapes_at(disc, disc.rings.front(), theta);
}

Shapes shapes_at(const InertialDisc& disc, const InertialRing& ring, double theta)
{
  Shapes shapes{ring.U, ring.U_r, Eigen::VectorXd::Zero(disc.n_modes())};
  for (Eigen::Index i = 0; i < disc.n_modes(); ++i) {
    const int n = disc.nodal_diameters[static_cast<std::size_t>(i)];
    if (n == 0) continue;
    const Eigen::Vector2d along{std::cos(n * theta), std::sin(n * theta)};
    shapes.W.segment<2>(i) = ring.U[i] * along;
    shapes.W_r.segment<2>(i) = ring.U_r[i] * along;
    shapes.W_t.segment<2>(i) = ring.U_t[i] * Eigen::Vector2d{-along[1], along[0]};
    ++i;
  }
  return shapes;
}

}  // namespace chladni::squeal
