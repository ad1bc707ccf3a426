#include "squeal/condensation/condensation.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/modal_body.hpp"
#include "squeal/assembly/assembly.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using mbs_export::ModalBody;

namespace {

/// What the parts of a brake do in some of its eigenvectors, each of which has the energy one.
struct PartMotions {
  Eigen::MatrixXcd disc;                ///< [n_disc x k] coordinates of the inertial disc
  std::vector<Eigen::MatrixXcd> parts;  ///< [n_i x k] modes of each part; empty for the disc
};

/// A shape that a part takes: a linear combination of the modes of its body, or for the disc the
/// two that turn into each other.
struct PartShape {
  std::size_t part;
  Eigen::MatrixXd columns;  ///< [n_modes x 1 or 2]
  double size;              ///< root mean square of its energy over the eigenvectors
};

constexpr double smallest = 1e-8;

/// Real and imaginary parts side by side.
MatrixXd real_columns(const MatrixXcd& Y)
{
  MatrixXd both(Y.rows(), 2 * Y.cols());
  both << Y.real(), Y.imag();
  return both;
}

MatrixXd beside(const MatrixXd& A, const MatrixXd& B)
{
  if (A.size() == 0) return B;
  MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// Left singular vectors of diag(weights) Y over the weights, and the singular values.
struct PrincipalComponents {
  MatrixXd shapes;
  VectorXd sizes;
};

PrincipalComponents principal_components(const MatrixXd& Y, const VectorXd& weights)
{
  const MatrixXd weighted = weights.asDiagonal() * Y;
  const Eigen::JacobiSVD<MatrixXd> svd(weighted, Eigen::ComputeThinU);
  return {weights.cwiseInverse().asDiagonal() * svd.matrixU(),
          svd.singularValues() / std::sqrt(0.5 * double(Y.cols()))};
}

VectorXd weights_of(const VectorXd& frequencies, double omega)
{
  return (frequencies.array().square() + omega * omega).sqrt();
}

/// Coordinates of the inertial disc with so many nodal diameters: the first ones of pairs.
std::vector<Index> first_of(const InertialDisc& disc, int n)
{
  std::vector<Index> first;
  for (Index i = 0; i < disc.n_modes(); ++i) {
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] != n) continue;
    first.push_back(i);
    if (n > 0) ++i;
  }
  return first;
}

/// What each position of the disc says of the radial shapes of one number of nodal diameters.
void add_disc_shapes(std::vector<PartShape>& shapes, std::size_t part, const Assembly& all,
                     Index n_modes, std::span<const PartMotions> motions, double omega)
{
  const InertialDisc& disc = all.disc;
  const int highest = *std::ranges::max_element(disc.nodal_diameters);
  for (int n = 0; n <= highest; ++n) {
    const std::vector<Index> cosines = first_of(disc, n);
    if (cosines.empty()) continue;
    std::vector<Index> sines = cosines;
    for (Index& i : sines) ++i;
    MatrixXd Y;
    for (const PartMotions& motion : motions) {
      Y = beside(Y, real_columns(motion.disc(cosines, every)));
      if (n > 0) Y = beside(Y, real_columns(motion.disc(sines, every)));
    }
    const PrincipalComponents found =
        principal_components(Y, weights_of(disc.omega(cosines), omega));
    for (Index k = 0; k < found.sizes.size(); ++k) {
      MatrixXd columns = MatrixXd::Zero(n_modes, n > 0 ? 2 : 1);
      for (Index row = 0; row < std::ssize(all.disc_modes); ++row) {
        const Index mode = all.disc_modes[static_cast<std::size_t>(row)] - 1;
        columns(mode, 0) = disc.R(row, cosines) * found.shapes.col(k);
        if (n > 0) columns(mode, 1) = disc.R(row, sines) * found.shapes.col(k);
      }
      shapes.push_back({part, std::move(columns), found.sizes[k]});
    }
  }
}

/// @param modes  of the state matrix of `all`
PartMotions part_motions(const Assembly& all, const AssemblyOptions& options,
                         std::span<const mbs_export::ModalBody> bodies, const BandModes& modes)
{
  const Index n = all.n_coordinates(), n_disc = all.disc.n_modes();
  MatrixXcd Z = state_scales(all).cwiseInverse().asDiagonal() * modes.X.topRows(n);
  VectorXd omega(n);
  omega << all.disc.omega, all.omega;
  for (Index k = 0; k < Z.cols(); ++k) {
    const double kinetic = std::norm(modes.lambda[k]) * Z.col(k).squaredNorm();
    const double elastic = omega.cwiseProduct(Z.col(k).cwiseAbs()).squaredNorm();
    Z.col(k) /= std::sqrt(kinetic + elastic);
  }
  PartMotions motions{.disc = Z.topRows(n_disc), .parts = {}};
  const MatrixXcd Q = all.X * Z.bottomRows(n - n_disc);
  Index first = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool turns = options.parts[i].name == options.disc;
    const Index rows = turns ? 0 : bodies[i].n_modes();
    motions.parts.push_back(Q.middleRows(first, rows));
    first += rows;
  }
  return motions;
}

/// Principal components of the motions of each part, the largest of all parts first. Those of the
/// disc are components of each number of nodal diameters, in all positions alike. Components below
/// 1e-8 of the largest one are left out.
/// @param omega  by which displacements are weighted beside the frequencies, rad/s
std::vector<PartShape> principal_shapes(const Assembly& all, const AssemblyOptions& options,
                                        std::span<const mbs_export::ModalBody> bodies,
                                        std::span<const PartMotions> motions, double omega)
{
  std::vector<PartShape> shapes;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (options.parts[i].name == options.disc) {
      add_disc_shapes(shapes, i, all, bodies[i].n_modes(), motions, omega);
      continue;
    }
    MatrixXd Y;
    for (const PartMotions& motion : motions) Y = beside(Y, real_columns(motion.parts[i]));
    const PrincipalComponents found = principal_components(Y, weights_of(bodies[i].omega, omega));
    for (Index k = 0; k < found.sizes.size(); ++k)
      shapes.push_back({i, found.shapes.col(k), found.sizes[k]});
  }
  std::ranges::stable_sort(shapes, std::ranges::greater(), &PartShape::size);
  if (shapes.empty()) return shapes;
  const double limit = smallest * shapes.front().size;
  std::erase_if(shapes, [limit](const PartShape& shape) { return shape.size < limit; });
  return shapes;
}

/// The shapes of one part side by side.
/// @return [n_modes x k]
MatrixXd columns_of(std::span<const PartShape> shapes, std::size_t part, Index n_modes)
{
  MatrixXd columns(n_modes, 0);
  for (const PartShape& shape : shapes) {
    if (shape.part != part) continue;
    columns.conservativeResize(n_modes, columns.cols() + shape.columns.cols());
    columns.rightCols(shape.columns.cols()) = shape.columns;
  }
  return columns;
}

using Bodies = std::vector<ModalBody>;

/// A state of the brake in which it is looked at.
struct BrakeState {
  double speed;     ///< rad/s
  double friction;  ///< part of the friction of the scene
};

/// A state, and what the complete brake does in it.
struct KnownState {
  BrakeState at;
  BandModes modes;
};

MatrixXd matrix_of(const Assembly& all, const BrakeState& at)
{
  std::vector<Lining> linings = all.linings;
  for (Lining& lining : linings) lining.friction = scaled(lining.friction, at.friction);
  return state_matrix(all, linings, at.speed);
}

/// A body without what no assembly needs.
ModalBody lean(ModalBody body)
{
  body.picture = {};
  body.resultants.clear();
  return body;
}

/// Shapes of all parts, the largest first, and how many of them are taken.
struct Choice {
  std::vector<PartShape> shapes;
  std::size_t n = 0;
  CondensationError error = {};
};

class Condensing {
 public:
  Condensing(const AssemblyOptions& options, std::span<const ModalBody> bodies,
             const CondensationOptions& wanted)
      : options_(options), wanted_(wanted), all_(assembly(options, bodies))
  {
    for (const ModalBody& body : bodies) bodies_.push_back(lean(body));
    for (const double speed : {wanted.speed_from, wanted.speed_to})
      for (const double friction : {0.0, 1.0}) add(state(speed, friction));
    int n = 0;
    for (const KnownState& sample : samples_) n += static_cast<int>(sample.modes.lambda.size());
    if (n == 0) {
      throw Error(
          fmt::format("the brake has no oscillation below {:.6g} Hz; take a wider band", end_Hz()));
    }
  }

  /// Bodies with some of the shapes of each part; none where a part has no shape.
  static Bodies with(std::span<const PartShape> shapes, std::span<const ModalBody> bodies)
  {
    Bodies few;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const MatrixXd of_part = columns_of(shapes, i, bodies[i].n_modes());
      if (of_part.cols() == 0) return {};
      few.push_back(mbs_export::condensed(bodies[i], of_part));
    }
    return few;
  }

  /// As few shapes as keep the tolerance in all samples and in states between them too. A state
  /// that they do not keep becomes a sample; the others are asked again of the new choice.
  Choice choose_for_all()
  {
    // Parts of the ranges of speed and friction.
    constexpr std::array<std::array<double, 2>, 3> places{{{0.5, 0.5}, {0.25, 0.75}, {0.75, 0.25}}};
    std::vector<KnownState> between;
    for (const auto& [of_speeds, of_friction] : places) {
      const double speed = std::lerp(wanted_.speed_from, wanted_.speed_to, of_speeds);
      between.push_back(state(speed, of_friction));
    }
    for (;;) {
      Choice choice = choose();
      CondensationError error = choice.error;
      const auto missed = std::ranges::find_if(between, [&](const KnownState& at) {
        const CondensationError here = error_in(choice, at);
        error = worst_of(error, here);
        return !(here.eigenvalues <= wanted_.tolerance);
      });
      if (missed == between.end()) {
        choice.error = error;
        return choice;
      }
      add(std::move(*missed));
      between.erase(missed);
    }
  }

 private:
  void add(KnownState sample) { samples_.push_back(std::move(sample)); }

  KnownState state(double speed, double friction) const
  {
    return {{speed, friction}, band_modes(matrix_of(all_, {speed, friction}), wanted_.highest)};
  }

  /// As few shapes as bisection finds to keep the tolerance in all samples.
  Choice choose()
  {
    Choice choice{.shapes = shapes_of_all()};
    choice.n = choice.shapes.size();
    choice.error = error_of(choice.shapes);
    if (!(choice.error.eigenvalues <= wanted_.tolerance)) {
      const auto [reached, asked] = told_apart(choice.error.eigenvalues, wanted_.tolerance);
      throw Error(fmt::format(
          "all shapes of the brake's vibrations up to {:.6g} Hz leave an error of {} where {} is "
          "asked; take a wider band, or a larger tolerance{}",
          end_Hz(), reached, asked,
          why_.empty() ? why_ : fmt::format(" (the condensed brake: {})", why_)));
    }
    std::size_t too_few = 0;
    while (choice.n - too_few > 1) {
      const std::size_t middle = (too_few + choice.n) / 2;
      const CondensationError error = error_of(std::span(choice.shapes).first(middle));
      if (error.eigenvalues <= wanted_.tolerance) {
        choice.error = error;
        choice.n = middle;
      } else {
        too_few = middle;
      }
    }
    return choice;
  }

  /// In a state that may be none of the samples.
  CondensationError error_in(const Choice& choice, const KnownState& at)
  {
    const Bodies few = with(std::span(choice.shapes).first(choice.n), bodies_);
    return condensation_error(at.modes.lambda, matrix_of(assembly(options_, few), at.at), wanted_);
  }

  double end_Hz() const { return wanted_.highest / (2.0 * std::numbers::pi); }

  std::vector<PartShape> shapes_of_all() const
  {
    std::vector<PartMotions> motions;
    for (const KnownState& sample : samples_)
      motions.push_back(part_motions(all_, options_, bodies_, sample.modes));
    return principal_shapes(all_, options_, bodies_, motions, 0.5 * wanted_.highest);
  }

  /// A brake that the bodies do not hold, or whose disc is none, is no better than none.
  CondensationError error_of(std::span<const PartShape> shapes)
  {
    constexpr CondensationError useless{.eigenvalues = 1.0};
    why_.clear();
    const Bodies few = with(shapes, bodies_);
    if (few.empty()) {
      why_ = "a part has no share in the vibrations of the band";
      return useless;
    }
    try {
      const Assembly brake = assembly(options_, few);
      CondensationError error;
      for (const KnownState& sample : samples_) {
        error = worst_of(
            error, condensation_error(sample.modes.lambda, matrix_of(brake, sample.at), wanted_));
      }
      return error;
    } catch (const Error& failure) {
      why_ = failure.what();
      return useless;
    }
  }

  const AssemblyOptions& options_;
  const CondensationOptions& wanted_;
  Assembly all_;
  Bodies bodies_;
  std::vector<KnownState> samples_;
  std::string why_;  ///< the last condensed brake was none
};

}  // namespace

CondensedBodies condense(const AssemblyOptions& options, std::span<const ModalBody> bodies,
                         const CondensationOptions& wanted)
{
  Condensing condensing(options, bodies, wanted);
  const Choice choice = condensing.choose_for_all();
  CondensedBodies found{
      .bodies = Condensing::with(std::span(choice.shapes).first(choice.n), bodies),
      .error = choice.error};
  for (ModalBody& body : found.bodies) {
    body.condensation = mbs_export::Condensation{.brake = wanted.brake,
                                                 .highest = wanted.highest,
                                                 .tolerance = wanted.tolerance,
                                                 .error = choice.error.eigenvalues};
  }
  return found;
}

namespace {

using Complex = std::complex<double>;

/// Growth below this part of the frequency is neither growth nor decay.
constexpr double neutral = 1e-4;

/// Eigenvalues with Im >= 0: an oscillation near critical damping may have become two decays.
std::vector<Complex> of_upper_half(const VectorXcd& lambda)
{
  std::vector<Complex> upper;
  for (const Complex& one : lambda)
    if (one.imag() >= 0.0) upper.push_back(one);
  return upper;
}

/// Whether an eigenvalue is an oscillation of the band, and remains one within the tolerance. Near
/// the end of the band, and near critical damping, it may be one in one of the brakes alone.
bool is_oscillation_of_band(const Complex& lambda, const CondensationOptions& wanted)
{
  const double size = std::abs(lambda);
  const double doubt = std::max(0.01 * wanted.highest, 2.0 * wanted.tolerance * size);
  return lambda.imag() > 2.0 * std::sqrt(wanted.tolerance) * size &&
         lambda.imag() + doubt <= wanted.highest;
}

/// Of each exact eigenvalue the place of its own among those found: the nearest pairs first.
std::vector<std::size_t> partners(const VectorXcd& exact, const std::vector<Complex>& found)
{
  struct Pair {
    double distance;
    std::size_t exact, found;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < static_cast<std::size_t>(exact.size()); ++i)
    for (std::size_t j = 0; j < found.size(); ++j)
      pairs.push_back({std::abs(exact[Index(i)] - found[j]), i, j});
  std::ranges::sort(pairs, {}, &Pair::distance);
  std::vector<std::size_t> partner(static_cast<std::size_t>(exact.size()), found.size());
  std::vector<bool> taken(found.size(), false);
  for (const auto& [distance, i, j] : pairs) {
    if (partner[i] < found.size() || taken[j]) continue;
    partner[i] = j;
    taken[j] = true;
  }
  return partner;
}

bool changes_stability(const Complex& exact, const Complex& found)
{
  const double limit = neutral * std::abs(exact);
  return std::max(std::abs(exact.real()), std::abs(found.real())) > limit &&
         exact.real() * found.real() < 0.0;
}

}  // namespace

CondensationError condensation_error(const VectorXcd& exact, const Eigen::MatrixXd& A,
                                     const CondensationOptions& wanted)
{
  const std::vector<Complex> found = of_upper_half(linear::real_eigenvalues(A));
  const std::vector<std::size_t> partner = partners(exact, found);
  CondensationError error{.n_eigenvalues = static_cast<int>(exact.size()), .n_states = 1};
  for (std::size_t i = 0; i < partner.size(); ++i) {
    const Complex& one = exact[Index(i)];
    if (partner[i] == found.size()) {
      error.eigenvalues = 1.0;
      continue;
    }
    const Complex& mine = found[partner[i]];
    error.eigenvalues = std::max(error.eigenvalues, std::abs(mine - one) / std::abs(one));
    error.growth = std::max(error.growth, std::abs(mine.real() - one.real()));
    if (changes_stability(one, mine)) error.eigenvalues = 1.0;
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    const bool is_own = std::ranges::find(partner, j) != partner.end();
    if (!is_own && is_oscillation_of_band(found[j], wanted)) error.eigenvalues = 1.0;
    const bool grows = found[j].real() > neutral * std::abs(found[j]);
    if (found[j].imag() > wanted.highest && grows) ++error.n_unstable_beyond;
  }
  return error;
}

CondensationError worst_of(const CondensationError& one, const CondensationError& other)
{
  return {.eigenvalues = std::max(one.eigenvalues, other.eigenvalues),
          .growth = std::max(one.growth, other.growth),
          .n_eigenvalues = one.n_eigenvalues + other.n_eigenvalues,
          .n_states = one.n_states + other.n_states,
          .n_unstable_beyond = std::max(one.n_unstable_beyond, other.n_unstable_beyond)};
}

}  // namespace chladni::squeal
