#include "cases/reduce_sectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "cases/harmonic_certificate.hpp"
#include "cases/harmonic_options.hpp"
#include "cases/harmonic_part.hpp"
#include "cases/ranks.hpp"
#include "cases/reduced_harmonics.hpp"
#include "cases/sector_deviations.hpp"
#include "cases/sector_forces.hpp"
#include "cases/sector_integrals.hpp"
#include "cases/sector_matrices.hpp"
#include "common/all_ranks.hpp"
#include "reduce_export/reduced_system.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd;

double certified_up_to(const reduce::ReduceOptions& wanted)
{
  double f_Hz = wanted.certified_up_to_Hz.value_or(std::numeric_limits<double>::infinity());
  if (wanted.tolerance) f_Hz = wanted.tolerance->up_to_Hz;
  return std::pow(2.0 * std::numbers::pi * f_Hz, 2);
}

Described described_body(const scene::Scene& scene, const SectorModel& model,
                         const reduce::ReductionOptions& options,
                         const SectorDeviations& deviations)
{
  Described described{.system = described_whole(scene, model),
                      .support = sector_support(scene, model),
                      .lambda_max = certified_up_to(options.basis),
                      .chosen = picture_nodes(model.mesh, scene.pictures),
                      .mass = {},
                      .with_forces = !scene.resultants.groups.empty(),
                      .deviating = deviations.rows,
                      .responses = {}};
  described.responses = harmonic_responses(scene, model, described.system, described.support);
  on_all_ranks(PETSC_COMM_WORLD, [&] {
    if (scene.mass_integrals) described.mass = std::make_unique<SectorMass>(scene, model);
    return 0;
  });
  return described;
}

/// All that the file has, on the first rank; the parts give back what no later step wants.
/// @note   Collective on all ranks: they have the same phases.
mbs_export::ReducedSystem whole_body(const scene::Scene& scene, const SectorModel& model,
                                     std::vector<HarmonicPart>& parts, const Described& described,
                                     const SectorDeviations& deviations, Phases& phases)
{
  const Index n_m = described.system.n_masters();
  mbs_export::ReducedSystem whole;
  phases.begin("whole body");
  on_first_rank([&] {
    whole = unfolded(described.system, model, parts, described.support.names, described.lambda_max);
    if (described.responses) add_responses(whole.certificate, parts, described.responses->names);
  });
  if (described.mass) {
    phases.begin("mass integrals");
    on_first_rank(
        [&] { whole.mass_integrals = sector_integrals(*described.mass, parts, whole.M, n_m); });
  }
  if (described.with_forces) {
    phases.begin("section forces");
    on_first_rank(
        [&] { whole.resultants = sector_forces(scene, model, parts, whole.M.rows(), n_m); });
  }
  MatrixXd T;
  if (!deviations.sectors.empty()) {
    phases.begin("deviations");
    on_first_rank([&] {
      T = add_deviations(whole, deviations, parts, model.dofs.count);
      report::tell_note(
          "deviations: errors of frequencies are not estimated, and modes are not counted; both "
          "are "
          "known of the body without its [[deviation]] tables alone");
    });
  }
  for (HarmonicPart& part : parts) {
    part.sector = {};
    part.deviating = {};
    part.mass = {};
  }
  if (!described.chosen.nodes.empty()) {
    phases.begin("pictures");
    on_first_rank([&] {
      add_picture(whole, described.chosen, model, parts);
      whole.picture_of_sectors->T = std::move(T);
    });
  }
  phases.end();
  return whole;
}

ReduceSummary summary_of(const SectorModel& model, const std::vector<HarmonicPart>& parts)
{
  ReduceSummary summary{};
  for (const HarmonicPart& part : parts) {
    summary.n_dofs += part.n_coordinates;
    summary.n_modes += static_cast<int>(part.omega.size());
    summary.factorization.wall_s += part.factor_s;
    summary.modes_residual = std::max(summary.modes_residual, part.modes_residual);
    summary.factor.entries = std::max(summary.factor.entries, part.factor_entries);
  }
  summary.n_nodes = std::int64_t{model.mesh.sectors.count} *
                    (model.mesh.n_nodes() - std::ssize(model.mesh.sectors.pairs));
  summary.factorization.name = "factorization";
  return summary;
}

}  // namespace

ReduceSummary reduce_sectors(const scene::Scene& scene, MeshedScene meshed,
                             const linear::SolverOptions& solver, Phases& phases)
{
  phases.begin("assembly");
  SectorModel model = on_all_ranks(PETSC_COMM_WORLD, [&] {
    return meshed.sector ? std::move(*meshed.sector) : sector_model(scene, std::move(meshed.mesh));
  });
  const HarmonicGroups groups(cyclic::n_harmonics(model.dofs.count), scene.ranks_per_harmonic);
  const cyclic::SectorMatrices matrices = matrices_of(model, groups.comm());
  model.dofs.mirror = mirror_of(model, matrices);
  phases.begin("modes of harmonics");
  const reduce::ReductionOptions options = harmonic_options(
      scene, model, matrices, solver, sector_support(scene, model).is_held, groups);
  const SectorDeviations deviations =
      on_all_ranks(PETSC_COMM_WORLD, [&] { return sector_deviations(scene, model); });
  const Described described = described_body(scene, model, options, deviations);
  phases.begin("harmonics");
  std::vector<HarmonicPart> parts =
      gathered(reduced_harmonics(model, matrices, options, described, groups));
  ReduceSummary summary = summary_of(model, parts);
  summary.choice = harmonic_method(scene.reduce);
  summary.n_masters = static_cast<int>(described.system.masters.size());
  summary.reduced = whole_body(scene, model, parts, described, deviations, phases);
  summary.phases = phases.times();
  return summary;
}

}  // namespace chladni::cases
