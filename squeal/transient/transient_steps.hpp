#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/motion/state_archive.hpp"
#include "squeal/results/results.hpp"
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

  /// Archives all data that the further samples depend on.
  virtual void exchange(StateArchive& archive) = 0;
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

}  // namespace chladni::squeal
