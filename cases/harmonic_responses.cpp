#include "cases/harmonic_responses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "cases/harmonic_options.hpp"
#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/reference_response.hpp"
#include "mbs_export/response_sizes.hpp"
#include "reduce/held_masters.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Components = std::array<bool, 6>;

/// Which components of each node on the axis and of each ring are loaded.
struct LoadedPlaces {
  std::vector<Components> axis, rings;

  bool operator()(const cyclic::Master& master) const
  {
    const auto component = std::size_t(master.component);
    return master.ring < 0 ? axis[std::size_t(master.place)][component]
                           : rings[std::size_t(master.ring)][component];
  }
};

Components loaded_components(const mbs_export::ReducedSystem& whole,
                             const mbs_export::LoadedDofs& loads, const std::string& set)
{
  const int node = mbs_export::find_set(whole, set).nodes.front();
  Components loaded{};
  for (int c = 0; c < 6; ++c)
    loaded[std::size_t(c)] = std::ranges::count(loads.dofs, 6 * node + c) > 0;
  return loaded;
}

/// Forces that turn with the body, on masters alone.
std::optional<LoadedPlaces> loaded_places(const SectorModel& model,
                                          const mbs_export::ReducedSystem& whole,
                                          const mbs_export::LoadedDofs& loads)
{
  LoadedPlaces places;
  for (const std::string& name : model.interface.axis_names)
    places.axis.push_back(loaded_components(whole, loads, name));
  for (std::size_t r = 0; r < model.dofs.rings.size(); ++r) {
    const cyclic::Ring& ring = model.dofs.rings[r];
    const Components loaded = loaded_components(whole, loads, model.interface.ring_names[r]);
    const bool is_loaded = std::ranges::count(loaded, true) > 0;
    if (is_loaded && ring.up_to < ring.n_nodes / 2) return std::nullopt;
    places.rings.push_back(loaded);
  }
  for (const std::vector<Components>* all : {&places.axis, &places.rings})
    for (const Components& loaded : *all)
      if (loaded[0] != loaded[1] || loaded[3] || loaded[4] || loaded[5]) return std::nullopt;
  return places;
}

/// Modes of the model with some rows held, [n x k].
struct HeldModes {
  VectorXd omega;
  MatrixXd X;
};

HeldModes held_modes(const reduce::ReducedModel& model, const std::vector<int>& held)
{
  const std::vector<int> free = reduce::all_but(held, model.K.rows());
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(model.K(free, free),
                                                                  model.M(free, free));
  constexpr double round_off = 1e-12;
  const VectorXd& lambda = solver.eigenvalues();
  const double least = round_off * lambda[lambda.size() - 1];
  HeldModes modes{.omega = (lambda.array() > least).select(lambda, 0.0).cwiseSqrt(),
                  .X = MatrixXd::Zero(model.K.rows(), lambda.size())};
  modes.X(free, every) = solver.eigenvectors();
  return modes;
}

reduce::ResponseLoads loads_of(const reduce::ReducedModel& model, const std::vector<int>& loaded,
                               const std::vector<int>& held, const mbs_export::Tolerance& tolerance)
{
  const HeldModes modes = held_modes(model, held);
  const mbs_export::LoadedDofs forces{
      .dofs = loaded, .is_moment = std::vector<char>(loaded.size(), 0), .names = {}, .groups = {}};
  const mbs_export::ResponseSizes sizes = mbs_export::response_sizes(
      mbs_export::reference_modes(modes.omega, modes.X(loaded, every).transpose(), forces),
      tolerance);
  // A force at a node of a ring is a sum of these columns, whose errors add up.
  const double together = std::sqrt(static_cast<double>(loaded.size()));
  reduce::ResponseLoads loads{.F = MatrixXd::Zero(model.n_masters, std::ssize(loaded)),
                              .Omega = sizes.Omega,
                              .size = sizes.size / together,
                              .loss_factor = mbs_export::stiffness_factor().imag()};
  for (std::size_t j = 0; j < loaded.size(); ++j)
    loads.F(loaded[j], Index(j)) = sizes.unit[Index(j)];
  return loads;
}

}  // namespace

std::optional<HarmonicResponses> harmonic_responses(const scene::Scene& scene,
                                                    const SectorModel& model,
                                                    const mbs_export::ReducedSystem& whole,
                                                    const SectorSupport& support)
{
  const std::optional<mbs_export::Tolerance>& tolerance = scene.body.keep.tolerance;
  if (!tolerance || support.names != scene.body.fixed ||
      harmonic_method(scene.reduce).method != reduce::Method::mixed_interface)
    return std::nullopt;
  const mbs_export::HeldDofs support_dofs = mbs_export::held_dofs(whole, scene.body.fixed);
  if (std::ssize(support_dofs.dofs) == 6 * std::ssize(whole.attachment_nodes)) return std::nullopt;
  const mbs_export::LoadedDofs loads =
      mbs_export::loaded_dofs(whole, support_dofs, scene.body.interface_modes);
  const std::optional<LoadedPlaces> places = loaded_places(model, whole, loads);
  if (!places) return std::nullopt;
  constexpr double share = 1.0 / 3.0;
  const auto loads_of_harmonic = [is_loaded = *places, tolerance = *tolerance](
                                     const reduce::ReducedModel& reduced,
                                     const std::vector<cyclic::Master>& masters,
                                     const std::vector<int>& held) {
    std::vector<int> loaded;
    for (std::size_t i = 0; i < masters.size(); ++i)
      if (is_loaded(masters[i]) && std::ranges::count(held, static_cast<int>(i)) == 0)
        loaded.push_back(static_cast<int>(i));
    return loads_of(reduced, loaded, held, tolerance);
  };
  return HarmonicResponses{.goal = {.Omega = 2.0 * std::numbers::pi * tolerance->up_to_Hz,
                                    .tolerance = share * tolerance->error,
                                    .is_loaded = *places,
                                    .loads = loads_of_harmonic},
                           .names = loads.names};
}

}  // namespace chladni::cases
