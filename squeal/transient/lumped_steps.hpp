#pragma once

#include <vector>

#include "squeal/models/lumped_brake.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {

/// Steps of order 8 per period of the highest frequency of a lumped brake; growth rates are then
/// accurate to about 1e-9 of the frequency.
inline constexpr int lumped_steps_per_period = 40;

/// A transient of a lumped brake at constant speed by fixed steps of order 8, at t_i = i step. A
/// step in which a contact opens or closes is of first order.
class LumpedSteps final : public TransientSteps {
  /// @param brake  must outlive the steps
  /// @param step   s
 public:
  /// @param brake  outlives the steps
  /// @param step   s
  LumpedSteps(const LumpedBrake& brake, const TransientCase& run, double step);

  const std::vector<ContactResult<double>>& next() override;
  std::int64_t n_steps() const override { return n_; }
  std::int64_t n_contact_evaluations() const override { return n_evaluations_; }
  void exchange(StateArchive& archive) override { archive(x_, n_, n_evaluations_); }

 private:
  const LumpedBrake& brake_;
  double speed_, step_;
  Eigen::VectorXd x_;  ///< state at the next sample
  std::vector<ContactResult<double>> contacts_;
  std::int64_t n_ = 0;
  std::int64_t n_evaluations_ = 0;
};

}  // namespace chladni::squeal
