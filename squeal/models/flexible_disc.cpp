#include "squeal/models/flexible_disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/motion/disc_motion.hpp"

namespace chladni::squeal {

namespace {

Disc that_keeps(Disc disc, bool asymmetry)
{
  disc.keeps_asymmetry = asymmetry;
  return disc;
}

}  // namespace

FlexibleDisc::FlexibleDisc(Disc disc, SquealOptions options,
                           std::shared_ptr<const FlexibleDisc> complete)
    : disc_(std::make_shared<const Disc>(that_keeps(std::move(disc), options.keeps_asymmetry))),
      inertial_(std::make_shared<const std::optional<InertialDisc>>(find_inertial_disc(*disc_))),
      options_(std::move(options)),
      complete_(std::move(complete))
{}

const InertialDisc& FlexibleDisc::inertial() const
{
  if (const auto why = *inertial_ ? std::nullopt : asymmetry(*disc_)) {
    throw Error(fmt::format(
        "the disc is not axisymmetric: {}. Its equations have the period of a rotation, so that it "
        "has no limit cycle and no state matrix whose modes could be left out one by one: instead "
        "of \"limit-cycle-direct\" and \"limit-cycle-branch\" ask for \"transient\" with "
        "\"motion-statistics\", and for \"gradients\" instead of \"mode-sensitivity\"",
        *why));
  }
  return inertial_->value();
}

Eigen::MatrixXd FlexibleDisc::state_matrix(double speed) const
{
  return squeal::state_matrix(inertial(), options_, speed);
}

std::unique_ptr<Brake> FlexibleDisc::with(MapParameter parameter, double value) const
{
  auto changed = std::make_unique<FlexibleDisc>(*this);
  changed->options_ = with_parameter(options_, parameter, value);
  changed->complete_.reset();
  return changed;
}

std::unique_ptr<FlexibleDisc> FlexibleDisc::between(SquealOptions options) const
{
  auto changed = std::make_unique<FlexibleDisc>(*this);
  changed->options_ = std::move(options);
  changed->complete_.reset();
  return changed;
}

std::vector<BrakeNumber> FlexibleDisc::further_numbers() const
{
  return disc_frequencies(inertial(), [this](InertialDisc disc) {
    auto changed = std::make_unique<FlexibleDisc>(*this);
    changed->inertial_ = std::make_shared<const std::optional<InertialDisc>>(std::move(disc));
    changed->complete_.reset();
    return changed;
  });
}

std::unique_ptr<AutonomousMotion> FlexibleDisc::motion(double speed) const
{
  return std::make_unique<SlidingDisc>(inertial(), options_, speed);
}

double FlexibleDisc::rest_compression() const
{
  return options_.pads.front().preload / options_.pads.front().stiffness;
}

}  // namespace chladni::squeal
