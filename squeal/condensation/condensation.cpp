#include "squeal/condensation/condensation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "mbs_export/condensed_body.hpp"
#include "squeal/assembly/assembly.hpp"
#include "squeal/condensation/condensation_error.hpp"
#include "squeal/condensation/part_shapes.hpp"
#include "squeal/stability/band_modes.hpp"

namespace chladni::squeal {
namespace {

using Eigen::MatrixXd;
using mbs_export::ModalBody;
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

 private:
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
  Choice choice = condensing.choose();
  // Parts of the ranges of speed and friction that are none of the samples.
  constexpr std::array<std::array<double, 2>, 3> between{{{0.5, 0.5}, {0.25, 0.75}, {0.75, 0.25}}};
  for (const auto& [of_speeds, of_friction] : between) {
    KnownState check = condensing.state(
        wanted.speed_from + of_speeds * (wanted.speed_to - wanted.speed_from), of_friction);
    const CondensationError error = condensing.error_in(choice, check);
    if (error.eigenvalues <= wanted.tolerance) {
      choice.error = worst_of(choice.error, error);
      continue;
    }
    condensing.add(std::move(check));
    choice = condensing.choose();
  }
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

}  // namespace chladni::squeal
