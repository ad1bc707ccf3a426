#include "mbs_export/held_body.hpp"

#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/drilling.hpp"

namespace chladni::mbs_export {

HeldBody held_body(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  FreeModes free = orthogonalize(reduced);
  HeldDofs held = held_dofs(reduced, fixed);
  refuse_drilling_support(reduced, held);
  ModeShift shift = shift_modes(free, held);
  ConstrainedModes constrained = constrained_modes(shift);
  Eigen::MatrixXd T = free.Q_e * (shift.Q_c * constrained.X);
  Eigen::MatrixXd U = attachment_motion(reduced, T);
  return {.free = std::move(free),
          .held = std::move(held),
          .shift = std::move(shift),
          .constrained = std::move(constrained),
          .T = std::move(T),
          .U = std::move(U)};
}

}  // namespace chladni::mbs_export
