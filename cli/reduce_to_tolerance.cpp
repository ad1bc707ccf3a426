#include "cli/reduce_steps.hpp"
#include "reduce/tolerance_search.hpp"

namespace chladni::cli {
namespace {

reduce::FixedInterfaceModes modes_to_tolerance(const Scene& scene, const FeModel& fe,
                                               const reduce::GrowingModel::System& system,
                                               const std::vector<PetscInt>& masters, Phases& phases)
{
  // Frequencies of too few modes are too high: some beyond the range belong into it.
  constexpr double beyond = 1.25;
  ModeRange range = certified_range(scene, 0.0);
  range.omega_max *= beyond;
  const auto pairs_in_range = [&](const reduce::ReducedModel& model) {
    const std::vector<int> places =
        coordinate_places(masters, static_cast<PetscInt>(model.omega.size()));
    return held_pairs(to_file_order(scene, fe, model, places), places, certified_support(scene, fe),
                      range)
        .pairs;
  };
  // What the estimates from the small matrices and those from the FE model may differ by.
  constexpr double margin = 0.99;
  const reduce::ModesByTolerance& wanted = *scene.reduce.tolerance;
  reduce::ToleranceSearch search(
      system, {.tolerance = margin * wanted.tolerance, .up_to_Hz = wanted.up_to_Hz},
      pairs_in_range);
  const auto find_modes = [&] {
    search.find_modes();
    return 0;
  };
  do {
    phases.run("fixed-interface modes", find_modes);
  } while (!phases.run("choice of modes", [&] { return search.is_enough(); }));
  return phases.run("fixed-interface modes", [&] { return search.modes(); });
}

}  // namespace

Reduced reduce_to_tolerance(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                            const reduce::Factorization& K_ss, Phases& phases)
{
  reduce::CraigBamptonBasis Q_CB = constraint_basis(blocks, K_ss, phases);
  Q_CB.modes =
      modes_to_tolerance(scene, fe, {.K_ss = K_ss, .Psi = Q_CB.Psi, .K = blocks.K, .M = blocks.M},
                         blocks.masters, phases);
  return project_blocks(scene, fe, blocks, std::move(Q_CB), phases);
}

}  // namespace chladni::cli
