#include "cases/scene_support.hpp"

#include <cmath>

#include "common/eigen_every.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/held_modes.hpp"
#include "reduce_export/reduced_system.hpp"

namespace chladni::cases {

SceneSupport::SceneSupport(mbs_export::ReducedSystem described,
                           const std::vector<PetscInt>& masters, std::vector<std::string> fixed)
    : described_(std::move(described)), masters_(masters), fixed_(std::move(fixed))
{}

std::vector<PetscInt> SceneSupport::held() const
{
  std::vector<PetscInt> held;
  for (const int row : mbs_export::held_dofs(described_, fixed_).rows)
    held.push_back(masters_[static_cast<std::size_t>(row)]);
  return held;
}

reduce::SupportedModes SceneSupport::modes(const reduce::ReducedModel& model,
                                           const reduce::SpectrumRange& wanted) const
{
  const std::vector<int> places = reduce::coordinate_places(masters_, model);
  const mbs_export::HeldModeShapes held =
      mbs_export::held_mode_shapes(reduce_export::with_model(described_, model, places), fixed_,
                                   {.lambda_max = wanted.lambda_max, .most = wanted.most});
  reduce::SupportedModes modes{
      .pairs = {.X = Eigen::MatrixXd::Zero(model.K.rows(), held.omega.size()), .lambda = {}},
      .are_all = std::isinf(wanted.lambda_max) && wanted.most >= model.K.rows(),
      .n_zero = held.n_rigid,
      .n_free_zero = held.n_free_rigid};
  modes.pairs.X(places, every) = held.X;
  for (const double omega : held.omega) modes.pairs.lambda.push_back(omega * omega);
  return modes;
}

double SceneSupport::zero_energy(const reduce::ReducedModel& model,
                                 const reduce::SupportedModes& /*modes*/) const
{
  return mbs_export::rigid_residual(
      reduce_export::with_model(described_, model, reduce::coordinate_places(masters_, model)));
}

}  // namespace chladni::cases
