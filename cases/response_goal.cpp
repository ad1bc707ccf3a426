#include "cases/response_goal.hpp"

#include <numbers>

#include "mbs_export/reference_response.hpp"
#include "mbs_export/response_sizes.hpp"
#include "reduce/reduction.hpp"
#include "reduce_export/reduced_system.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd;

/// Loads in the units in which errors are compared, in the rows of a model.
reduce::ResponseLoads loads_of(const mbs_export::ResponseSizes& sizes,
                               const std::vector<int>& places, Index n_masters)
{
  reduce::ResponseLoads loads{.F = MatrixXd::Zero(n_masters, std::ssize(sizes.rows)),
                              .Omega = sizes.Omega,
                              .size = sizes.size,
                              .loss_factor = mbs_export::stiffness_factor().imag()};
  for (std::size_t j = 0; j < sizes.rows.size(); ++j) {
    const int row = places[static_cast<std::size_t>(sizes.rows[j])];
    loads.F(row, Index(j)) = sizes.unit[Index(j)];
  }
  return loads;
}

}  // namespace

bool may_keep_responses(const scene::Scene& scene)
{
  using enum reduce::Method;
  const reduce::Method method = scene.reduce.method;
  return scene.body.keep.tolerance && (method == automatic || method == mixed_interface);
}

std::optional<SceneResponses> scene_responses(const scene::Scene& scene,
                                              mbs_export::ReducedSystem described,
                                              std::vector<PetscInt> masters,
                                              const std::vector<std::string>& fixed)
{
  const std::optional<mbs_export::Tolerance>& tolerance = scene.body.keep.tolerance;
  if (!tolerance || described.ring_motion || fixed != scene.body.fixed) return std::nullopt;
  constexpr double share = 1.0 / 3.0;
  auto names = std::make_shared<std::vector<std::string>>();
  const auto loads = [names, described = std::move(described), masters = std::move(masters),
                      options = scene.body](const reduce::ReducedModel& model) {
    const std::vector<int> places = reduce::coordinate_places(masters, model);
    const mbs_export::ResponseSizes sizes =
        mbs_export::response_sizes(reduce_export::with_model(described, model, places), options);
    *names = sizes.names;
    return loads_of(sizes, places, model.n_masters);
  };
  return SceneResponses{.goal = {.Omega = 2.0 * std::numbers::pi * tolerance->up_to_Hz,
                                 .tolerance = share * tolerance->error,
                                 .loads = loads},
                        .names = std::move(names)};
}

}  // namespace chladni::cases
