#include "cli/certify.hpp"

#include <mpi.h>

#include <algorithm>

#include "cli/petsc_session.hpp"
#include "mbs_export/held_modes.hpp"

namespace chladni::cli {
namespace {

using Eigen::Index;

constexpr Index most_modes = 100;  // of a certificate: bounds its block solve

/// Elastic modes up to omega_max, in the coordinates of the reduced model.
reduce::ReducedPairs to_model_order(const mbs_export::HeldModeShapes& held,
                                    const Reduction& reduction, double omega_max)
{
  const auto n_below =
      static_cast<Index>(std::ranges::upper_bound(held.omega, omega_max) - held.omega.begin());
  const Index k = std::min(std::max<Index>(n_below, 1), std::min(most_modes, held.omega.size()));
  reduce::ReducedPairs pairs{.X = {reduction.model.K.n_rows, static_cast<PetscInt>(k)},
                             .lambda = {}};
  for (Index j = 0; j < k; ++j) {
    pairs.lambda.push_back(held.omega[j] * held.omega[j]);
    for (Index i = 0; i < held.X.rows(); ++i) {
      pairs.X(reduction.places[static_cast<std::size_t>(i)], static_cast<PetscInt>(j)) =
          held.X(i, j);
    }
  }
  return pairs;
}

/// The pairs of the first rank on all ranks.
reduce::ReducedPairs broadcast(reduce::ReducedPairs pairs)
{
  int k = static_cast<int>(pairs.lambda.size());
  int n = pairs.X.n_rows;
  MPI_Bcast(&k, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (rank() != 0) pairs = {.X = {n, k}, .lambda = std::vector<double>(k)};
  MPI_Bcast(pairs.X.values.data(), n * k, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  MPI_Bcast(pairs.lambda.data(), k, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return pairs;
}

}  // namespace

mbs_export::ReducedSystem with_modes(const mbs_export::ReducedSystem& system, int n_modes)
{
  const Index n = system.n_masters() + n_modes;
  mbs_export::ReducedSystem cut = system;
  cut.K = system.K.topLeftCorner(n, n);
  cut.M = system.M.topLeftCorner(n, n);
  if (system.C.size() > 0) cut.C = system.C.topLeftCorner(n, n);
  cut.fixed_interface_frequencies = system.fixed_interface_frequencies.head(n_modes);
  return cut;
}

mbs_export::Certificate certify(const mbs_export::ReducedSystem& system, const Reduction& reduction,
                                const std::vector<std::string>& fixed, int n_modes,
                                double omega_max)
{
  reduce::ReducedPairs pairs{.X = {0, 0}, .lambda = {}};
  on_first_rank([&] {
    pairs = to_model_order(mbs_export::held_mode_shapes(with_modes(system, n_modes), fixed),
                           reduction, omega_max);
  });
  pairs = broadcast(std::move(pairs));
  const std::vector<double> eta2 =
      reduce::error_estimates(reduction.K_ss, reduction.Q_CB, reduction.M, pairs);
  const auto k = static_cast<Index>(eta2.size());
  return {.fixed = fixed,
          .frequencies = Eigen::Map<const Eigen::VectorXd>(pairs.lambda.data(), k).cwiseSqrt(),
          .eta2 = Eigen::Map<const Eigen::VectorXd>(eta2.data(), k)};
}

}  // namespace chladni::cli
