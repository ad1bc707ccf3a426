#include "cases/possible_sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "cases/ranks.hpp"
#include "cases/scene_mesh.hpp"
#include "cases/scene_support.hpp"
#include "cases/sector_model.hpp"
#include "common/all_ranks.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/response_error.hpp"
#include "mbs_export/select_by_tolerance.hpp"
#include "mesh/sectors.hpp"
#include "plate/sections/sections.hpp"
#include "reduce/support.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// A coupling of the whole body has one reference node. That of a sector would be another one in
/// each, unless its group goes on from sector to sector about a reference node on the axis.
void refuse_groups_in_parts(const scene::Scene& scene, const mesh::Mesh& sector)
{
  const auto is_cut = [&](int node) {
    return std::ranges::any_of(sector.sectors.pairs,
                               [&](const auto& pair) { return pair[0] == node; });
  };
  for (const plate::Coupling& coupling : scene.couplings) {
    if (coupling.kind == plate::CouplingKind::link) continue;
    const std::vector<int>& group = mesh::find_group(sector, coupling.group).nodes;
    const bool is_on_axis =
        !coupling.at || mesh::is_on_axis(*coupling.at, mesh::outer_radius(sector));
    const bool is_rigid = coupling.kind == plate::CouplingKind::rigid;
    if (is_rigid && coupling.has_reference_node() && is_on_axis &&
        std::ranges::any_of(group, is_cut))
      continue;
    throw Error(
        fmt::format("sectors: the coupling \"{}\" joins nodes of several sectors that do not meet, "
                    "or their mean",
                    coupling.has_reference_node() ? coupling.name : coupling.group));
  }
}

/// A thickness or an offset that a turn by one sector changes.
void refuse_uneven(const plate::Profile& profile, const std::string& group, const mesh::Mesh& whole,
                   int count)
{
  constexpr double digits = 1e-9;
  const mesh::Sectors sectors{.count = count, .pairs = {}};
  for (const int node : mesh::find_group(whole, group).nodes) {
    const std::array<double, 3> x = whole.positions[std::size_t(node)];
    const double here = plate::value_at(profile, x);
    const double there = plate::value_at(profile, mesh::turned(sectors, x));
    if (std::abs(here - there) <= digits * std::max(std::abs(here), std::abs(there))) continue;
    throw Error(fmt::format(
        "sectors: the section of \"{}\" is not the same in all of the {} repetitions of the mesh",
        group, count));
  }
}

/// What has a direction of its own: the sectors of a whole body do not turn it.
void require_turning(const std::string& place, const char* what, bool turns)
{
  if (turns) return;
  throw Error(fmt::format(
      "sectors: the {} \"{}\" has directions of its own, which do not turn with the sectors", what,
      place));
}

void refuse_what_does_not_turn(const scene::Scene& scene, const mesh::Mesh& whole, int count)
{
  for (const plate::ShellSection& section : scene.sections) {
    refuse_uneven(section.thickness, section.group, whole, count);
    refuse_uneven(section.offset, section.group, whole, count);
  }
  for (const plate::BeamSection& beam : scene.beams) {
    const bool turns =
        !beam.orientation || ((*beam.orientation)[0] == 0.0 && (*beam.orientation)[1] == 0.0);
    require_turning(beam.group, "section of beams", turns);
  }
  for (const plate::PointMass& mass : scene.masses)
    require_turning(mass.at, "mass at", turns_with_sectors(mass));
  for (const plate::Spring& spring : scene.springs)
    require_turning(spring.at, "spring at", turns_with_sectors(spring));
}

/// What the file of the whole body would tell and that of one sector not; empty where there is
/// nothing.
std::string lost_by(const scene::Scene& scene, const SectorModel& sector)
{
  if (!has_size(scene.mesh)) return "the node numbers of the mesh file";
  if (!scene.resultants.groups.empty()) return "the element numbers of section forces";
  if (!scene.stiffening.empty()) return "the geometric stiffness";
  const SectorSupport support = sector_support(scene, sector);
  if (support.names != scene.body.fixed) return "errors under the support of [body]";
  const bool certifies_responses = may_keep_responses(scene) && scene.ring_harmonics.empty();
  if (!certifies_responses ||
      harmonic_responses(scene, sector, described_whole(scene, sector), support))
    return "";
  return "the certificate of responses";
}

}  // namespace

SectorModel sector_of(const scene::Scene& scene, const mesh::Mesh& whole, int count)
{
  refuse_what_does_not_turn(scene, whole, count);
  mesh::Mesh first = mesh::one_sector(whole, count);
  refuse_groups_in_parts(scene, first);
  return sector_model(scene, std::move(first));
}

std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole)
{
  using mesh::SectorSearch;
  const SectorSearch search = scene.mesh.sector_search;
  if (search == SectorSearch::none) return std::nullopt;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least_sectors) throw Error("sectors: the mesh does not repeat about the z axis");
    SectorModel sector = sector_of(scene, whole, count);
    const bool is_asked = search == SectorSearch::asked;
    if (const std::string lost = is_asked ? "" : lost_by(scene, sector); !lost.empty()) {
      report::tell_note(fmt::format(
          "sectors: the body repeats {} times; from one sector, which sectors = \"auto\" in [mesh] "
          "would take, {} would be lost: the whole body is reduced",
          count, lost));
      return std::nullopt;
    }
    report::tell_note(
        fmt::format("sectors: the body repeats {} times and is reduced from one sector{}", count,
                    is_asked ? "" : "; sectors = 1 in [mesh] would take the whole body"));
    return sector;
  } catch (const Error& error) {
    if (search == SectorSearch::asked)
      report::tell_note(fmt::format("{}; the whole body is reduced", error.what()));
    return std::nullopt;
  }
}

MeshedScene meshed_scene(const scene::Scene& scene)
{
  MeshedScene meshed;
  meshed.mesh = mesh_on_all_ranks(scene, [&](mesh::Mesh whole) {
    meshed.sector = possible_sector(scene, whole);
    return meshed.sector ? meshed.sector->mesh : std::move(whole);
  });
  return meshed;
}

namespace {

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

reduce::ResponseLoads response_loads_of_sector(const reduce::ReducedModel& model,
                                               const std::vector<int>& loaded,
                                               const std::vector<int>& held,
                                               const mbs_export::Tolerance& tolerance)
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
  const mbs_export::LoadedDofs loads =
      mbs_export::loaded_dofs(whole, support_dofs, scene.body.interface_modes);
  if (loads.dofs.empty()) return std::nullopt;
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
    return response_loads_of_sector(reduced, loaded, held, tolerance);
  };
  return HarmonicResponses{.goal = {.Omega = 2.0 * std::numbers::pi * tolerance->up_to_Hz,
                                    .tolerance = share * tolerance->error,
                                    .is_loaded = *places,
                                    .loads = loads_of_harmonic},
                           .names = loads.names};
}

namespace {

/// The frequency below which the whole body has so many modes of the method, Hz, both of a pair
/// with it.
double frequency_of_modes(int n_modes, const SectorModel& model,
                          const cyclic::SectorMatrices& matrices,
                          const reduce::ReductionOptions& options, const cyclic::IsHeld& is_held,
                          const HarmonicGroups& groups)
{
  const int count = model.dofs.count;
  const std::vector<int>& orders = groups.own();
  int asked = 2 + 4 * n_modes / cyclic::n_harmonics(count);
  std::vector<std::vector<double>> omega(orders.size());
  for (;;) {
    std::vector<double> own, last;
    on_all_ranks(PETSC_COMM_WORLD, [&] {
      for (std::size_t i = 0; i < orders.size(); ++i) {
        if (std::ssize(omega[i]) < asked) {
          omega[i] = cyclic::lowest_frequencies(matrices,
                                                cyclic::harmonic_coordinates(model.dofs, orders[i]),
                                                asked, options, is_held);
        }
        if (!groups.speaks()) continue;
        own.insert(own.end(), omega[i].begin(), omega[i].end());
        last.push_back(omega[i].back());
      }
      return 0;
    });
    std::vector<double> all = joined(own);
    const std::vector<double> ends = joined(last);
    std::ranges::sort(all);
    if (std::ssize(all) >= n_modes) {
      constexpr double both = 1.0 + 1e-6;
      const double wanted = all[std::size_t(n_modes - 1)] * both;
      if (std::ranges::all_of(ends, [&](double end) { return end > wanted; }))
        return wanted / (2.0 * std::numbers::pi);
    }
    asked *= 2;
  }
}

}  // namespace

reduce::MethodChoice harmonic_method(const reduce::ReduceOptions& wanted)
{
  if (wanted.method != reduce::Method::automatic) return {.method = wanted.method};
  if (!wanted.tolerance) return {.method = reduce::Method::craig_bampton};
  return {.method = reduce::Method::mixed_interface,
          .reason =
              "a harmonic of the sectors has few masters: modes that leave them free cost "
              "hardly more than fixed-interface modes, of which more would be needed"};
}

reduce::ReductionOptions harmonic_options(const scene::Scene& scene, const SectorModel& model,
                                          const cyclic::SectorMatrices& matrices,
                                          const linear::SolverOptions& solver,
                                          const cyclic::IsHeld& is_held,
                                          const HarmonicGroups& groups)
{
  reduce::ReductionOptions options{
      .basis = scene.reduce,
      .solver = solver,
      .count = scene.accuracy ? scene.sylvester.value_or(true) : scene.sylvester,
      .keeps_matrices = true,
      .later = {}};
  options.basis.method = harmonic_method(scene.reduce).method;
  if (scene.reduce.modes) {
    options.basis.cutoff_Hz =
        frequency_of_modes(*scene.reduce.modes, model, matrices, options, is_held, groups);
    options.basis.modes.reset();
  }
  if (options.basis.cutoff_Hz) options.basis.certified_up_to_Hz = options.basis.cutoff_Hz;
  return options;
}

}  // namespace chladni::cases
