#include <cmath>

#include "cli/certify.hpp"
#include "cli/reduce_steps.hpp"
#include "reduce/completeness.hpp"
#include "reduce/sylvester.hpp"

namespace chladni::cli {
namespace {

mbs_export::ModeCount as_mode_count(const reduce::EigenvalueCount& count)
{
  return {.up_to = std::sqrt(count.sigma), .expected = count.expected, .found = count.found};
}

/// Up to the last one; modes that close to it are never cut off.
mbs_export::ModeCount count_fixed_interface(const Partitioned& blocks, const Eigen::VectorXd& omega)
{
  constexpr double half_a_pair_gap = 1e-4;  // of omega^2
  const double sigma = std::pow(omega[omega.size() - 1], 2) * (1.0 + half_a_pair_gap);
  return {.up_to = std::sqrt(sigma),
          .expected = reduce::eigenvalues_below(blocks.K.ss, blocks.M.ss, sigma),
          .found = static_cast<int>(omega.size())};
}

}  // namespace

mbs_export::Certificate count_scene(const FeModel& fe, const Partitioned& blocks,
                                    const mbs_export::ReducedSystem& system)
{
  mbs_export::Certificate certificate = system.certificate;
  const HeldSpectrum spectrum = held_spectrum(system);
  std::vector<PetscInt> held;
  for (const int row : spectrum.held_rows) {
    held.push_back(blocks.masters[static_cast<std::size_t>(row)]);
  }
  const reduce::Completeness count =
      reduce::count_modes({.lambda = spectrum.lambda,
                           .eta2 = {certificate.eta2.begin(), certificate.eta2.end()},
                           .n_zero = spectrum.n_rigid},
                          [&](double sigma) {
                            return reduce::eigenvalues_below(fe.system.K, fe.system.M, sigma, held);
                          });
  certificate.range = as_mode_count(count.range);
  certificate.complete = as_mode_count(count.complete);
  certificate.bounds =
      Eigen::Map<const Eigen::VectorXd>(count.bounds.data(), std::ssize(count.bounds));
  const Eigen::VectorXd& omega = system.fixed_interface_frequencies;
  if (omega.size() > 0) certificate.fixed_interface = count_fixed_interface(blocks, omega);
  return certificate;
}

}  // namespace chladni::cli
