#include "cases/scene_support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/response_error.hpp"
#include "mbs_export/select_by_tolerance.hpp"
#include "reduce/reduced_system.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;
using mbs_export::InterfaceModes, mbs_export::ReducedSystem;

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
      mbs_export::held_mode_shapes(reduce::with_model(described_, model, places), fixed_,
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
      reduce::with_model(described_, model, reduce::coordinate_places(masters_, model)));
}

namespace {

/// Loads in the units in which errors are compared, in the rows of a model.
reduce::ResponseLoads loads_of(const mbs_export::ResponseSizes& sizes,
                               const std::vector<int>& places, Index n_masters)
{
  reduce::ResponseLoads loads{.F = MatrixXd::Zero(n_masters, sizes.unit.size()),
                              .Omega = sizes.Omega,
                              .size = sizes.size,
                              .loss_factor = mbs_export::stiffness_factor().imag()};
  for (std::size_t j = 0; j < sizes.rows.size(); ++j) {
    const int row = places[static_cast<std::size_t>(sizes.rows[j])];
    if (sizes.spread.size() > 0)
      loads.F.row(row) = sizes.spread.row(Index(j)).cwiseProduct(sizes.unit.transpose());
    else
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
  const mbs_export::HeldDofs held = mbs_export::held_dofs(described, fixed);
  if (mbs_export::loaded_dofs(described, held, scene.body.interface_modes).dofs.empty())
    return std::nullopt;
  constexpr double share = 1.0 / 3.0;
  auto names = std::make_shared<std::vector<std::string>>();
  const auto loads = [names, described = std::move(described), masters = std::move(masters),
                      options = scene.body](const reduce::ReducedModel& model) {
    const std::vector<int> places = reduce::coordinate_places(masters, model);
    const mbs_export::ResponseSizes sizes =
        mbs_export::response_sizes(reduce::with_model(described, model, places), options);
    *names = sizes.names;
    return loads_of(sizes, places, model.n_masters);
  };
  return SceneResponses{.goal = {.Omega = 2.0 * std::numbers::pi * tolerance->up_to_Hz,
                                 .tolerance = share * tolerance->error,
                                 .loads = loads},
                        .names = std::move(names)};
}

namespace {

/// Rows of K_r that are loaded, for each omega0 in rad/s.
using Loads = std::map<double, std::set<int>>;

/// Half the first elastic free frequency; the same on every rank.
double automatic_omega0(const ReducedSystem& system)
{
  const mbs_export::FreeModes free = mbs_export::orthogonalize(system);
  double omega0 = free.n_rigid < free.omega.size() ? 0.5 * free.omega[free.n_rigid] : 0.0;
  MPI_Bcast(&omega0, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return omega0;
}

/// The loads of a ring of harmonics: its harmonics along or about its axis.
void add_axial_harmonics(const ReducedSystem& system, int set, int component, std::set<int>& rows)
{
  for (std::size_t row = 0; row < system.masters.size(); ++row) {
    const mbs_export::MasterDof& dof = system.masters[row];
    if (dof.harmonic && dof.harmonic->set == set && dof.component == component)
      rows.insert(static_cast<int>(row));
  }
}

/// Rows of K_r of one component of the loaded set.
void add_loads(const ReducedSystem& system, const InterfaceModes& wanted, int component,
               std::set<int>& rows)
{
  const mbs_export::AttachmentSet& set = mbs_export::find_set(system, wanted.at);
  const char* name = mbs_export::component_name(component);
  const auto index = static_cast<int>(&set - system.sets.data());
  const bool is_ring = std::ranges::any_of(
      system.masters, [&](const auto& dof) { return dof.harmonic && dof.harmonic->set == index; });
  for (const int node : set.nodes) mbs_export::refuse_drilling_load(system, node, component);
  if (is_ring && component % 3 == 2) return add_axial_harmonics(system, index, component, rows);
  for (const int node : set.nodes) {
    if (const auto row = mbs_export::master_row(system, node, component))
      rows.insert(*row);
    else if (mbs_export::has_component(system, node, component))
      throw Error(
          fmt::format("interface_modes at \"{}\": with space = \"full\", nodes of a ring of "
                      "harmonics are loaded "
                      "along z and rz only, not along {}; use space = \"reduced\"",
                      wanted.at, name));
    else
      throw Error(fmt::format("interface_modes at \"{}\": component {} is no DOF of the model",
                              wanted.at, name));
  }
}

Loads loads_of(const scene::Scene& scene, const ReducedSystem& system)
{
  const mbs_export::HeldDofs held = mbs_export::held_dofs(system, scene.body.fixed);
  if (!held.are_masters()) {
    throw Error(
        "interface_modes: with space = \"full\" nodes of a ring of harmonics cannot be held; use "
        "space = \"reduced\"");
  }
  Loads loads;
  for (const InterfaceModes& wanted : scene.body.interface_modes) {
    if (wanted.space != InterfaceModes::Space::full) continue;
    std::set<int>& rows = loads[wanted.omega0 ? *wanted.omega0 : automatic_omega0(system)];
    rows.insert(held.rows.begin(), held.rows.end());
    for (const int component : wanted.components) add_loads(system, wanted, component, rows);
  }
  return loads;
}

}  // namespace

bool wants_full_responses(const scene::Scene& scene)
{
  return std::ranges::any_of(scene.body.interface_modes, [](const InterfaceModes& wanted) {
    return wanted.space == InterfaceModes::Space::full;
  });
}

std::vector<reduce::HarmonicLoads> full_response_loads(const scene::Scene& scene,
                                                       const ReducedSystem& system,
                                                       const std::vector<PetscInt>& masters)
{
  std::vector<reduce::HarmonicLoads> loads;
  for (const auto& [omega0, rows] : loads_of(scene, system)) {
    loads.push_back({.Omega_0 = omega0, .loaded = {}});
    for (const int row : rows)
      loads.back().loaded.push_back(masters[static_cast<std::size_t>(row)]);
  }
  return loads;
}

}  // namespace chladni::cases
