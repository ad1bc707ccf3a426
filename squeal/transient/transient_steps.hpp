#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/transient/integrator_choice.hpp"

namespace chladni::squeal {

/// A transient as equally spaced samples, with a class for each integrator.
class TransientSteps {
 public:
  TransientSteps() = default;
  TransientSteps(const TransientSteps&) = delete;
  TransientSteps& operator=(const TransientSteps&) = delete;
  virtual ~TransientSteps() = default;

  /// Advances to the next sample.
  /// @return contact states at the sample, one for each pad pair; not finite when the motion
  ///         diverges; valid until the next call
  virtual const std::vector<ContactResult<double>>& next() = 0;

  virtual std::int64_t n_steps() const = 0;
  virtual std::int64_t n_contact_evaluations() const = 0;
  virtual std::vector<ContactEvent> events() const { return {}; }
  virtual std::int64_t n_events() const { return 0; }
};

/// A transient of a disc with a body, sampled at t_i = (i + 1/2) step.
class ModalSteps : public TransientSteps {
 public:
  /// The modal state at the sample, in the frame that rotates with the disc.
  virtual ModalState state() const = 0;
};

/// Samples per period of the highest mode for adaptive integrators.
inline constexpr int samples_per_period = 20;

/// The steps of the integrator `choice.kind` from the state `start` at t = 0.
/// @param step  distance of the samples, s; for "splitting" and "exponential" also the integration
///         step
std::unique_ptr<ModalSteps> transient_steps(const Disc& disc, const SquealOptions& options,
                                            const TransientCase& run,
                                            const IntegratorChoice& choice, double step,
                                            const ModalState& start);

/// Steps of order 8 per period of the highest frequency of a lumped brake; growth rates are then
/// accurate to about 1e-9 of the frequency.
inline constexpr int lumped_steps_per_period = 40;

/// A transient of a lumped brake at constant speed by fixed steps of order 8, at t_i = i step. A
/// step in which a contact opens or closes is of first order.
class LumpedSteps final : public TransientSteps {
 public:
  /// @param brake  outlives the steps
  /// @param step   s
  LumpedSteps(const LumpedBrake& brake, const TransientCase& run, double step);

  const std::vector<ContactResult<double>>& next() override;
  std::int64_t n_steps() const override { return n_; }
  std::int64_t n_contact_evaluations() const override { return n_evaluations_; }

 private:
  const LumpedBrake& brake_;
  double speed_, step_;
  Eigen::VectorXd x_;  ///< state at the next sample
  std::vector<ContactResult<double>> contacts_;
  std::int64_t n_ = 0;
  std::int64_t n_evaluations_ = 0;
};

}  // namespace chladni::squeal
