#include <cmath>

#include "cli/certify.hpp"
#include "cli/petsc_session.hpp"
#include "cli/reduce_steps.hpp"
#include "reduce/completeness.hpp"
#include "reduce/machine_memory.hpp"
#include "reduce/sylvester.hpp"

namespace chladni::cli {
namespace {

mbs_export::ModeCount as_mode_count(const reduce::EigenvalueCount& count)
{
  return {.up_to = std::sqrt(count.sigma), .expected = count.expected, .found = count.found};
}

}  // namespace

CountOfEigenvalues::CountOfEigenvalues(const Scene& scene, const Partitioned& blocks,
                                       const reduce::Factorization& K_ss)
    : scene_(scene),
      factor_(reduce::factor_size(K_ss.factor())),
      n_masters_(static_cast<double>(blocks.masters.size()))
{
  PetscInt n = 0;
  petsc::check(MatGetSize(blocks.K.ss, &n, nullptr));
  n_slaves_ = static_cast<double>(n);
}

double CountOfEigenvalues::share(int n_modes) const
{
  // MUMPS, which pivots, takes about four times as long for an operation as our factor, and two
  // counts are made; block Lanczos takes 3.2 vectors for each mode.
  constexpr double of_both_counts = 8.0, vectors_for_mode = 3.2;
  const double n_vectors = vectors_for_mode * n_modes;
  const double solutions = 4.0 * factor_.entries * (0.5 * n_masters_ + n_vectors + n_modes);
  const double products = n_slaves_ * (n_masters_ * n_masters_ + 2.0 * n_masters_ * n_modes +
                                       2.0 * n_vectors * n_vectors);
  const double count = of_both_counts * factor_.operations;
  return count / (count + factor_.operations + solutions + products);
}

bool CountOfEigenvalues::is_due(int n_modes) const
{
  constexpr double cheap = 0.1;
  return scene_.sylvester.value_or(share(n_modes) < cheap);
}

bool CountOfEigenvalues::is_possible() const
{
  const reduce::ReduceOptions& wanted = scene_.reduce;
  if (wanted.method == reduce::Method::guyan) return is_due(0);
  return !wanted.modes || is_due(*wanted.modes);
}

bool CountOfEigenvalues::fits() const
{
  if (scene_.sylvester) return true;
  const double own_MiB =
      sizeof(double) * entries_of_mumps * factor_.entries / n_ranks() / reduce::bytes_in_MiB;
  return reduce::tightest_machine(own_MiB, reduce::free_MiB(), PETSC_COMM_WORLD).fits();
}

mbs_export::Certificate count_scene(const FeModel& fe, const Partitioned& blocks,
                                    const mbs_export::ReducedSystem& system,
                                    const reduce::SmallMatrix& residuals)
{
  mbs_export::Certificate certificate = system.certificate;
  const HeldSpectrum spectrum = held_spectrum(system);
  std::vector<PetscInt> held;
  for (const int row : spectrum.held_rows) {
    held.push_back(blocks.masters[static_cast<std::size_t>(row)]);
  }
  const reduce::Completeness count =
      reduce::count_modes({.lambda = spectrum.lambda,
                           .residuals = residuals,
                           .n_zero = spectrum.n_rigid,
                           .comm = PETSC_COMM_WORLD},
                          [&](double sigma) {
                            return reduce::eigenvalues_below(fe.system.K, fe.system.M, sigma, held);
                          });
  certificate.range = as_mode_count(count.range);
  certificate.complete = as_mode_count(count.complete);
  const auto n_bounds = std::ssize(count.bounds);
  certificate.bounds = Eigen::Map<const Eigen::VectorXd>(count.bounds.data(), n_bounds) +
                       certificate.rounding.head(n_bounds);
  // An estimate above its bound is known to be too high.
  certificate.estimates.head(n_bounds) =
      certificate.estimates.head(n_bounds).cwiseMin(0.5 * certificate.bounds);
  const Eigen::VectorXd& omega = system.fixed_interface_frequencies;
  if (omega.size() > 0) {
    certificate.fixed_interface = as_mode_count(reduce::count_fixed_interface(
        {omega.begin(), omega.end()},
        [&](double sigma) { return reduce::eigenvalues_below(blocks.K.ss, blocks.M.ss, sigma); }));
  }
  return certificate;
}

}  // namespace chladni::cli
