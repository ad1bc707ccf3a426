#include "squeal/transient/lumped_steps.hpp"

#include <limits>

#include "squeal/motion/dop853.hpp"
#include "squeal/transient/transient_plan.hpp"

namespace chladni::squeal {

LumpedSteps::LumpedSteps(const LumpedBrake& brake, const TransientCase& run, double step)
    : brake_(brake),
      speed_(run.speed),
      step_(step),
      x_(brake.start(run.initial_pad_displacement)),
      contacts_(1)
{}

const std::vector<ContactResult<double>>& LumpedSteps::next()
{
  contacts_[0] = brake_.contact(x_, speed_);
  ++n_evaluations_;
  if (!(x_.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < motion_max))
    contacts_[0].upper.z = std::numeric_limits<double>::quiet_NaN();
  const auto f = [&](const Eigen::VectorXd& x) {
    ++n_evaluations_;
    return brake_.rate(x, speed_);
  };
  x_ = dop853_step(f, x_, step_);
  ++n_;
  return contacts_;
}

}  // namespace chladni::squeal
