#include "squeal/assembly/condensation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/condensed_body.hpp"
#include "squeal/assembly/part_shapes.hpp"
#include "squeal/stability/band_modes.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd;
using mbs_export::ModalBody;

/// A state of the brake in which it is looked at.
struct BrakeState {
  double speed;     ///< rad/s
  double friction;  ///< part of the friction of the scene
};

/// A sample, and what the complete brake does in it.
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

KnownState known(const Assembly& all, const BrakeState& at, double highest)
{
  return {at, band_modes(matrix_of(all, at), highest)};
}

/// The largest distance of one of `from` from the nearest one of `to`, relative.
double farthest(const VectorXcd& from, const VectorXcd& to)
{
  double largest = 0.0;
  for (const Complex& one : from) {
    largest = std::max(largest,
                       to.size() == 0 ? 1.0 : (to.array() - one).abs().minCoeff() / std::abs(one));
  }
  return largest;
}

/// Of the eigenvalues within the band both ways. Those near its end may lie beyond it in one of the
/// brakes.
double error_of(const VectorXcd& exact, const MatrixXd& A, double highest)
{
  const VectorXcd all = A.eigenvalues();
  const VectorXcd in_band = band_modes(A, (1.0 - 1e-2) * highest).lambda;
  return std::max(farthest(exact, all), farthest(in_band, exact));
}

/// The parts of a brake, which become fewer modes.
class Condensing {
 public:
  Condensing(const AssemblyOptions& options, std::span<const ModalBody> bodies,
             const CondensationOptions& wanted)
      : options_(options), bodies_(bodies), wanted_(wanted), all_(assembly(options, bodies))
  {
    for (const double speed : {wanted.speed_from, wanted.speed_to})
      for (const double friction : {0.0, 1.0}) add(known(all_, {speed, friction}, wanted.highest));
    if (n_eigenvalues() == 0) {
      throw Error(fmt::format("the brake has no oscillation below {:.6g} Hz; take a wider band",
                              wanted.highest / (2.0 * std::numbers::pi)));
    }
  }

  int n_eigenvalues() const
  {
    int n = 0;
    for (const KnownState& sample : samples_) n += static_cast<int>(sample.modes.lambda.size());
    return n;
  }

  /// The fewest shapes that keep the tolerance in all samples, by bisection.
  CondensedBodies fewest() const
  {
    const std::vector<PartShape> shapes = shapes_of_all();
    const auto size = shapes.size();
    std::size_t too_few = 0, enough = size;
    CondensedBodies best = with(shapes);
    if (!(best.error <= wanted_.tolerance)) {
      throw Error(fmt::format(
          "all shapes of the brake's vibrations up to {:.6g} Hz leave an error of {:.2g} where "
          "{:.2g} is asked; take a wider band, or a larger tolerance",
          wanted_.highest / (2.0 * std::numbers::pi), best.error, wanted_.tolerance));
    }
    while (enough - too_few > 1) {
      const std::size_t middle = (too_few + enough) / 2;
      CondensedBodies tried = with(std::span(shapes).first(middle));
      if (tried.error <= wanted_.tolerance) {
        best = std::move(tried);
        enough = middle;
      } else {
        too_few = middle;
      }
    }
    return best;
  }

  /// In a state that may be none of the samples.
  double error_at(const CondensedBodies& condensed, const KnownState& sample) const
  {
    const Assembly few = assembly(options_, condensed.bodies);
    return error_of(sample.modes.lambda, matrix_of(few, sample.at), wanted_.highest);
  }

  KnownState middle() const
  {
    return known(all_, {0.5 * (wanted_.speed_from + wanted_.speed_to), 0.5}, wanted_.highest);
  }

  void add(KnownState sample) { samples_.push_back(std::move(sample)); }

 private:
  /// The shapes of all parts in all samples, the largest first.
  std::vector<PartShape> shapes_of_all() const
  {
    std::vector<PartMotions> motions;
    for (const KnownState& sample : samples_)
      motions.push_back(part_motions(all_, options_, bodies_, sample.modes));
    return principal_shapes(all_, options_, bodies_, motions, 0.5 * wanted_.highest);
  }

  /// The bodies with these shapes. A brake that they do not hold, or whose disc is none, is no
  /// better than none.
  CondensedBodies with(std::span<const PartShape> shapes) const
  {
    CondensedBodies few{.bodies = {},
                        .error = 1.0,
                        .n_samples = static_cast<int>(samples_.size()),
                        .n_eigenvalues = n_eigenvalues()};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const MatrixXd of_part = columns_of(shapes, i, bodies_[i].n_modes());
      if (of_part.cols() == 0) return few;
      few.bodies.push_back(mbs_export::condensed(bodies_[i], of_part));
    }
    try {
      const Assembly brake = assembly(options_, few.bodies);
      few.error = 0.0;
      for (const KnownState& sample : samples_) {
        const double error =
            error_of(sample.modes.lambda, matrix_of(brake, sample.at), wanted_.highest);
        few.error = std::max(few.error, error);
      }
    } catch (const Error&) {
      few.error = 1.0;
    }
    return few;
  }

  const AssemblyOptions& options_;
  std::span<const ModalBody> bodies_;
  const CondensationOptions& wanted_;
  Assembly all_;
  std::vector<KnownState> samples_;
};

}  // namespace

CondensedBodies condense(const AssemblyOptions& options, std::span<const ModalBody> bodies,
                         const CondensationOptions& wanted)
{
  Condensing condensing(options, bodies, wanted);
  CondensedBodies found = condensing.fewest();
  KnownState check = condensing.middle();
  const double error = condensing.error_at(found, check);
  if (error <= wanted.tolerance) {
    found.error = std::max(found.error, error);
    return found;
  }
  condensing.add(std::move(check));
  return condensing.fewest();
}

}  // namespace chladni::squeal
