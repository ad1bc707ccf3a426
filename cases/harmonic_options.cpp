#include "cases/harmonic_options.hpp"

#include <algorithm>
#include <numbers>

#include "cases/ranks.hpp"
#include "common/all_ranks.hpp"
#include "common/error.hpp"

namespace chladni::cases {

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
