#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/parameters.hpp"

namespace chladni::squeal {

/// A disc with a modal body between pads. It is autonomous, in the inertial frame, when the disc is
/// axisymmetric. Copies share the disc.
class FlexibleDisc final : public Brake {
 public:
  /// @param complete  the same brake with all modes of the body, if `disc` has a selection of them
  FlexibleDisc(Disc disc, SquealOptions options, std::shared_ptr<const FlexibleDisc> complete = {});

  const Disc& disc() const { return *disc_; }
  const SquealOptions& options() const { return options_; }
  /// The same brake with all modes of the body; null when this brake has them all.
  const FlexibleDisc* complete() const { return complete_.get(); }

  /// The disc in the inertial frame; absent when it is not axisymmetric.
  const std::optional<InertialDisc>& find_inertial() const { return *inertial_; }
  /// The disc in the inertial frame.
  /// @throws chladni::Error with the reason when the disc is not axisymmetric.
  const InertialDisc& inertial() const;

  bool is_autonomous() const override { return inertial_->has_value(); }
  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override { return parameter_values(options_); }
  /// Points of friction tables, and the frequency of each mode or pair of the disc.
  std::vector<BrakeNumber> further_numbers() const override;
  /// The same disc between other pads.
  /// @param options  with the same rings and modes of the body
  std::unique_ptr<FlexibleDisc> between(SquealOptions options) const;
  /// The SlidingDisc of this brake.
  /// @throws chladni::Error when the disc is not axisymmetric.
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;
  const FlexibleDisc* body() const override { return this; }

 private:
  std::shared_ptr<const Disc> disc_;
  std::shared_ptr<const std::optional<InertialDisc>> inertial_;
  SquealOptions options_;
  std::shared_ptr<const FlexibleDisc> complete_;
};

}  // namespace chladni::squeal
