#include "squeal/brake/inertial_frame.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>
#include <variant>

#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

/// Differences within the pairs that the mean over the circumference removes.
struct DampingDifference {
  double spread = 0.0;    ///< largest difference of decay rates within a pair, 1/s
  double contrast = 0.0;  ///< largest difference relative to the pair's mean decay rate
};

/// Mean over the circumference of exp(-phi D) C exp(phi D) for damping or Coriolis terms, exact
/// because more than 2 n_max + 1 angles are used.
/// @param C  [n_modes x n_modes] in the coordinates of the inertial disc
Eigen::MatrixXd averaged_over_angles(const InertialDisc& inertial, const Eigen::MatrixXd& C)
{
  const int n_max = *std::ranges::max_element(inertial.nodal_diameters);
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

/// Differences within each pair: half the distance of the eigenvalues of its block of C.
DampingDifference damping_difference(const InertialDisc& inertial, const Eigen::MatrixXd& C)
{
  DampingDifference largest;
  for (Eigen::Index i = 0; i < inertial.n_modes(); ++i) {
    if (inertial.nodal_diameters[static_cast<std::size_t>(i)] == 0) continue;
    const double half_difference = 0.5 * (C(i, i) - C(i + 1, i + 1));
    const double across = 0.5 * (C(i, i + 1) + C(i + 1, i));
    const double spread = std::hypot(half_difference, across);
    const double mean = 0.25 * (C(i, i) + C(i + 1, i + 1));
    largest.spread = std::max(largest.spread, spread);
    if (mean > 0.0) largest.contrast = std::max(largest.contrast, spread / mean);
    ++i;
  }
  return largest;
}

struct Complaint {
  std::string text;  ///< why a disc has no inertial frame, in words for the user
};

/// "the frequencies of a pair differ by 0.021 (allowed: 0.01)"
Complaint beyond(const char* what, double value, double limit)
{
  const auto [found, allowed] = told_apart(value, limit);
  return {fmt::format("{} {} (allowed: {})", what, found, allowed)};
}

/// The part of the motion of the rings, mode by mode and squared, that no harmonic space has.
Eigen::VectorXd unmatched(const RingHarmonics& harmonics, const std::vector<HarmonicSpace>& spaces)
{
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(harmonics.c.front().rows());
  for (std::size_t d = 0; d < harmonics.c.size(); ++d) {
    Eigen::MatrixXcd c = harmonics.c[d];
    for (const HarmonicSpace& space : spaces)
      if (space.d == static_cast<int>(d)) c -= space.E * (space.E.adjoint() * harmonics.c[d]);
    rest += c.cwiseAbs2().rowwise().sum();
  }
  return rest;
}

/// Of its squared motion, what no pair has.
constexpr double without_partner = 0.5;

std::optional<Complaint> mode_without_partner(const Disc& disc, const Eigen::VectorXd& unpaired)
{
  Eigen::Index i = 0;
  if (unpaired.maxCoeff(&i) < without_partner) return std::nullopt;
  const int n = nodal_diameters(disc)[static_cast<std::size_t>(i)];
  return Complaint{
      fmt::format("mode {} ({:.1f} Hz) has {} nodal diameters, but no partner among the modes used",
                  disc.mode_numbers[static_cast<std::size_t>(i)], disc.omega[i] / (2.0 * pi), n)};
}

/// A pair, or a mode without nodal diameters, in its own coordinates (cos, sin).
struct PureModes {
  int n;
  double omega;        ///< rad/s
  Eigen::VectorXcd e;  ///< of norm 1; S e = i n e
};

/// The modes of each space, whose stiffness is the mean over all positions of the disc.
std::vector<PureModes> pure_modes(const Disc& disc, const std::vector<HarmonicSpace>& spaces)
{
  std::vector<PureModes> all;
  for (const HarmonicSpace& space : spaces) {
    const Eigen::MatrixXcd omega = space.E.adjoint() * disc.omega.asDiagonal() * space.E;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(omega);
    for (Eigen::Index j = 0; j < omega.rows(); ++j)
      all.push_back({space.d, solver.eigenvalues()[j], space.E * solver.eigenvectors().col(j)});
  }
  std::ranges::stable_sort(all, {}, &PureModes::omega);
  return all;
}

/// Turned so that the motion of the rings that tells most of it is a cosine: displacement, or slope
/// in case a nodal circle lies on each ring.
/// @param n_functions  of each ring
Eigen::VectorXcd oriented(const PureModes& mode, const RingHarmonics& harmonics,
                          Eigen::Index n_functions)
{
  const auto at = static_cast<std::size_t>(mode.n);
  if (at >= harmonics.c.size()) return mode.e;
  std::complex<double> largest = 0.0;
  // W, W_r, W_t, V_r, V_t of one ring after the other; V_t is a sine where V_r is a cosine.
  const std::array<std::complex<double>, 5> weights{1.0, 0.1, 0.0, 0.5, {0.0, 0.5}};
  for (Eigen::Index k = 0; k < harmonics.c[at].cols(); ++k) {
    const std::complex<double> alpha =
        weights[static_cast<std::size_t>(k % n_functions)] * mode.e.dot(harmonics.c[at].col(k));
    if (std::abs(alpha) > std::abs(largest)) largest = alpha;
  }
  return std::abs(largest) > 0.0 ? mode.e * (largest / std::abs(largest)) : mode.e;
}

InertialDisc empty_inertial_disc(const Disc& disc)
{
  const Eigen::Index n = disc.n_modes();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n), none;
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(n, n);
  std::vector<InertialRing> rings;
  for (const DiscRing& ring : disc.rings) {
    const Eigen::VectorXd& in_plane = ring.V_r.cosine.size() > 0 ? zero : none;
    rings.push_back({ring.name, ring.radius, zero, zero, zero, in_plane, in_plane, ring.height});
  }
  return {.rings = rings,
          .nodal_diameters = std::vector<int>(static_cast<std::size_t>(n), 0),
          .omega = zero,
          .C = zeros,
          .G = zeros,
          .D = zeros,
          .R = zeros,
          .largest_split = 0.0,
          .largest_impurity = 0.0,
          .compliance = disc.compliance,
          .errors = {.mesh = disc.errors.mesh,
                     .mesh_shapes = disc.errors.mesh_shapes,
                     .reduction = disc.errors.reduction,
                     .responses = disc.errors.responses,
                     .mesh_compliances = disc.errors.mesh_compliances,
                     .n_harmonics = disc.errors.n_harmonics,
                     .range = disc.errors.range}};
}

/// Of a mode that consists of others, by their shares.
/// @param errors  [n_modes] of the disc, or none
void put_error(Eigen::VectorXd& inertial, const Eigen::VectorXd& errors, const Eigen::VectorXcd& e,
               Eigen::Index at, Eigen::Index size)
{
  if (errors.size() > 0) inertial.segment(at, size).setConstant(e.cwiseAbs2().dot(errors));
}

/// Puts modes at the coordinates `at` (and `at` + 1) of the inertial disc.
/// @return how far they are from pure harmonics
double put(InertialDisc& inertial, const RingHarmonics& harmonics, const PureModes& mode,
           Eigen::Index at)
{
  const Eigen::Index size = mode.n == 0 ? 1 : 2;
  const auto n_functions = static_cast<Eigen::Index>(amplitudes_of(inertial.rings.front()).size());
  const Eigen::VectorXcd e = oriented(mode, harmonics, n_functions);
  const double scale = size == 1 ? 1.0 : std::sqrt(2.0);
  inertial.R.col(at) = scale * e.real();
  if (size == 2) inertial.R.col(at + 1) = -scale * e.imag();
  for (Eigen::Index i = 0; i < size; ++i)
    inertial.nodal_diameters[static_cast<std::size_t>(at + i)] = mode.n;
  inertial.omega.segment(at, size).setConstant(mode.omega);
  if (size == 2) inertial.D.block<2, 2>(at, at) << 0.0, mode.n, -mode.n, 0.0;

  double whole = 0.0, pure = 0.0;
  for (const Eigen::MatrixXcd& c : harmonics.c)
    whole += (inertial.R.middleCols(at, size).transpose() * c).squaredNorm();
  if (static_cast<std::size_t>(mode.n) >= harmonics.c.size()) return 1.0;
  const Eigen::RowVectorXcd alpha =
      e.adjoint() * harmonics.c[static_cast<std::size_t>(mode.n)] / scale;
  Eigen::Index column = 0;
  for (InertialRing& ring : inertial.rings) {
    const std::vector<Eigen::VectorXd*> amplitudes = amplitudes_of(ring);
    for (std::size_t j = 0; j < amplitudes.size(); ++j, ++column) {
      const bool is_along = j == 2 || j == 4, is_slope = j == 1 || j == 2;
      const double value = is_along && size == 2 ? alpha[column].imag() : alpha[column].real();
      amplitudes[j]->segment(at, size).setConstant(is_slope ? value / ring.radius : value);
      pure += double(size) * value * value;
    }
  }
  return std::sqrt(std::max(0.0, whole - pure) / whole);
}

/// The error of a mode's shape that the errors of its frequency tell: in the norm of the energy it
/// is the root of that of lambda, 2 e, as for all Ritz vectors.
double shape_error(const ModeErrors& errors, const Eigen::VectorXcd& e)
{
  double of_frequency = 0.0;
  for (const Eigen::VectorXd* part : {&errors.mesh, &errors.reduction})
    if (part->size() > 0) of_frequency += e.cwiseAbs2().dot(*part);
  return std::sqrt(2.0 * of_frequency);
}

/// Twice the part of each frequency that is not the same in every position of the disc, relative:
/// for a pair alone the distance of its two frequencies.
double largest_split(const Disc& disc, const std::vector<HarmonicSpace>& spaces)
{
  Eigen::MatrixXd rest = disc.omega.asDiagonal();
  for (const HarmonicSpace& space : spaces) {
    const Eigen::MatrixXcd omega = space.E.adjoint() * disc.omega.asDiagonal() * space.E;
    rest -= (space.d == 0 ? 1.0 : 2.0) * (space.E * omega * space.E.adjoint()).real();
  }
  Eigen::VectorXd split = 2.0 * rest.rowwise().norm().cwiseQuotient(disc.omega);
  for (Eigen::Index i = 0; i < split.size(); ++i)
    if (disc.omega[i] > disc.range) split[i] /= beyond_range;
  return split.maxCoeff();
}

/// With C and G, both averaged, where that may be.
std::variant<InertialDisc, Complaint> with_damping(InertialDisc inertial, const Disc& disc)
{
  const Eigen::MatrixXd C = inertial.R.transpose() * disc.C * inertial.R;
  inertial.C = averaged_over_angles(inertial, C);
  inertial.G = averaged_over_angles(inertial, inertial.R.transpose() * disc.G * inertial.R);
  const DampingDifference difference = damping_difference(inertial, C);
  inertial.damping_spread = difference.spread;
  inertial.damping_contrast = difference.contrast;
  if (disc.keeps_asymmetry) {
    return Complaint{
        fmt::format("its small differences are kept (asymmetry = \"kept\"), {:.2g} of "
                    "the frequencies and {:.2g} 1/s of the damping of a pair",
                    inertial.largest_split, inertial.damping_spread)};
  }
  const double deviation = (C - inertial.C).norm();
  if (deviation > impurity_limit * C.norm()) {
    return beyond("its damping changes around the circumference by", deviation / C.norm(),
                  impurity_limit);
  }
  return inertial;
}

std::variant<InertialDisc, Complaint> try_inertial_disc(const Disc& disc)
{
  const RingHarmonics harmonics = ring_harmonics(disc.rings);
  const auto spaces = harmonic_spaces(rotation_generator(harmonics, disc.omega));
  const Eigen::VectorXd unpaired = unmatched(harmonics, spaces).cwiseQuotient(harmonics.squares());
  if (auto complaint = mode_without_partner(disc, unpaired)) return *complaint;
  InertialDisc inertial = empty_inertial_disc(disc);
  Eigen::Index at = 0;
  for (const PureModes& mode : pure_modes(disc, spaces)) {
    const double impurity =
        put(inertial, harmonics, mode, at) / (mode.omega > disc.range ? beyond_range : 1.0);
    double& largest = impurity < shape_error(disc.errors, mode.e) ? inertial.explained_impurity
                                                                  : inertial.largest_impurity;
    largest = std::max(largest, impurity);
    const Eigen::Index size = mode.n == 0 ? 1 : 2;
    put_error(inertial.errors.mesh, disc.errors.mesh, mode.e, at, size);
    for (Eigen::Index row = 0; row < disc.errors.mesh_shapes.rows(); ++row) {
      const double error = disc.errors.mesh_shapes.row(row).dot(mode.e.cwiseAbs2());
      inertial.errors.mesh_shapes.row(row).segment(at, size).setConstant(error);
    }
    put_error(inertial.errors.reduction, disc.errors.reduction, mode.e, at, size);
    at += size;
  }
  inertial.largest_split = largest_split(disc, spaces);
  if (!(inertial.largest_impurity < impurity_limit)) {
    return beyond("its mode shapes on the ring differ from pure harmonics by",
                  inertial.largest_impurity, impurity_limit);
  }
  if (!(inertial.largest_split < split_limit))
    return beyond("the frequencies of a pair differ by", inertial.largest_split, split_limit);
  return with_damping(std::move(inertial), disc);
}

}  // namespace

Eigen::VectorXd unpaired_shares(const Disc& disc)
{
  const RingHarmonics harmonics = ring_harmonics(disc.rings);
  const auto spaces = harmonic_spaces(rotation_generator(harmonics, disc.omega));
  return unmatched(harmonics, spaces).cwiseQuotient(harmonics.squares());
}

InertialDisc inertial_disc(const Disc& disc)
{
  auto outcome = try_inertial_disc(disc);
  if (const auto* complaint = std::get_if<Complaint>(&outcome)) {
    throw Error(fmt::format(
        "the disc is not axisymmetric: {}. Amplitudes in the frame that does not turn, and the "
        "matrix of an assembly, need an axisymmetric disc and both modes of each pair",
        complaint->text));
  }
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

std::vector<Eigen::VectorXd*> amplitudes_of(InertialRing& ring)
{
  std::vector<Eigen::VectorXd*> amplitudes{&ring.U, &ring.U_r, &ring.U_t};
  if (ring.V_r.size() > 0) amplitudes.insert(amplitudes.end(), {&ring.V_r, &ring.V_t});
  return amplitudes;
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
  for (const auto& ring : disc.rings) places.push_back({ring.name, ring.radius, ring.height});
  return places;
}

Shapes shapes_at(const InertialDisc& disc, double theta)
{
  return shapes_at(disc, disc.rings.front(), theta);
}

Shapes shapes_at(const InertialDisc& disc, const InertialRing& ring, double theta)
{
  Shapes shapes{ring.U, ring.U_r, ring.U_t, ring.V_r, ring.V_t};
  for (Eigen::Index i = 0; i < disc.n_modes(); ++i) {
    const int n = disc.nodal_diameters[static_cast<std::size_t>(i)];
    if (n == 0) continue;
    const Eigen::Vector2d across{std::cos(n * theta), std::sin(n * theta)};
    const Eigen::Vector2d along{-across[1], across[0]};
    for (Eigen::VectorXd* f : {&shapes.W, &shapes.W_r, &shapes.V_r})
      if (f->size() > 0) f->segment<2>(i) = (*f)[i] * across;
    for (Eigen::VectorXd* f : {&shapes.W_t, &shapes.V_t})
      if (f->size() > 0) f->segment<2>(i) = (*f)[i] * along;
    ++i;
  }
  return shapes;
}

}  // namespace chladni::squeal
