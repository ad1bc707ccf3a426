#include "mbs_export/held_modes.hpp"

#include "mbs_export/constrained_modes.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/mode_shift.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {

HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  const FreeModes free = orthogonalize(reduced);
  const ModeShift shift = shift_modes(free, held_dofs(reduced, fixed));
  const ConstrainedModes modes = constrained_modes(shift);
  const Eigen::Index n_elastic = modes.omega.size() - modes.n_rigid;
  return {.omega = modes.omega.tail(n_elastic),
          .X = free.Q_e * (shift.Q_c * modes.X.rightCols(n_elastic)),
          .n_rigid = modes.n_rigid,
          .n_free_rigid = free.n_rigid,
          .rigid_residual = free.rigid_residual};
}

}  // namespace chladni::mbs_export
