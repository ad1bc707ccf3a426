#include "mbs_export/held_modes.hpp"

#include <algorithm>

#include "common/eigen_every.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/constrained_modes.hpp"
#include "mbs_export/drilling.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/mode_shift.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;

/// All modes, where a held displacement is a combination of coordinates.
HeldModeShapes by_mode_shift(const ReducedSystem& reduced, const HeldDofs& held)
{
  const FreeModes free = orthogonalize(reduced);
  const ModeShift shift = shift_modes(free, held);
  const ConstrainedModes modes = constrained_modes(shift);
  const Index n_elastic = modes.omega.size() - modes.n_rigid;
  return {.omega = modes.omega.tail(n_elastic),
          .X = free.Q_e * (shift.Q_c * modes.X.rightCols(n_elastic)),
          .n_rigid = modes.n_rigid,
          .n_free_rigid = free.n_rigid};
}

std::vector<int> other_rows(const std::vector<int>& rows, Index n)
{
  std::vector<int> others;
  for (int i = 0; i < n; ++i)
    if (!std::ranges::binary_search(rows, i)) others.push_back(i);
  return others;
}

}  // namespace

HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                                const linear::LowestModes& wanted)
{
  const HeldDofs held = held_dofs(reduced, fixed);
  refuse_drilling_support(reduced, held);
  if (!held.are_masters()) return by_mode_shift(reduced, held);
  const RigidModes rigid = rigid_modes(reduced);
  const MatrixXd unheld = rigid.R * unheld_combinations(rigid.R(held.rows, every));
  const std::vector<int> rows = other_rows(held.rows, reduced.K.rows());
  const linear::Eigenmodes elastic = linear::lowest_eigenmodes(
      reduced.K(rows, rows), reduced.M(rows, rows), unheld(rows, every), wanted);
  HeldModeShapes shapes{.omega = elastic.lambda.cwiseSqrt(),
                        .X = MatrixXd::Zero(reduced.K.rows(), elastic.X.cols()),
                        .n_rigid = static_cast<int>(unheld.cols()),
                        .n_free_rigid = static_cast<int>(rigid.R.cols())};
  shapes.X(rows, every) = elastic.X;
  return shapes;
}

double rigid_residual(const ReducedSystem& reduced)
{
  const RigidModes rigid = rigid_modes(reduced);
  if (rigid.R.cols() == 0) return 0.0;
  const double first = linear::first_eigenvalue(reduced.K, reduced.M, rigid.R);
  return first > 0.0 ? rigid.largest_energy / first : 0.0;
}

}  // namespace chladni::mbs_export
