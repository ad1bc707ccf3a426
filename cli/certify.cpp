#include "cli/certify.hpp"

#include <mpi.h>

#include <algorithm>

#include "cli/petsc_session.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/held_modes.hpp"

namespace chladni::cli {
namespace {

using Eigen::Index;

/// Elastic modes of a range, in the coordinates of the reduced model.
reduce::ReducedPairs to_model_order(const mbs_export::HeldModeShapes& held,
                                    const std::vector<int>& places, const ModeRange& range)
{
  const auto n_below = static_cast<Index>(std::ranges::upper_bound(held.omega, range.omega_max) -
                                          held.omega.begin());
  const Index k =
      std::min(std::max<Index>(n_below, 1), std::min<Index>(range.most, held.omega.size()));
  reduce::ReducedPairs pairs{.X = {static_cast<PetscInt>(places.size()), static_cast<PetscInt>(k)},
                             .lambda = {}};
  for (Index j = 0; j < k; ++j) {
    pairs.lambda.push_back(held.omega[j] * held.omega[j]);
    for (Index i = 0; i < held.X.rows(); ++i) {
      pairs.X(places[static_cast<std::size_t>(i)], static_cast<PetscInt>(j)) = held.X(i, j);
    }
  }
  return pairs;
}

/// The values of the first rank on all ranks.
template <typename Value>
void broadcast(std::vector<Value>& values)
{
  auto n = static_cast<int>(values.size());
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  values.resize(static_cast<std::size_t>(n));
  MPI_Bcast(values.data(), n * static_cast<int>(sizeof(Value)), MPI_BYTE, 0, PETSC_COMM_WORLD);
}

/// The pairs of the first rank on all ranks.
reduce::ReducedPairs broadcast(reduce::ReducedPairs pairs)
{
  int k = static_cast<int>(pairs.lambda.size());
  int n = pairs.X.n_rows;
  MPI_Bcast(&k, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (rank() != 0) pairs = {.X = {n, k}, .lambda = std::vector<double>(k)};
  reduce::broadcast_numbers(pairs.X.values, PETSC_COMM_WORLD);
  MPI_Bcast(pairs.lambda.data(), k, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return pairs;
}

}  // namespace

HeldPairs held_pairs(const mbs_export::ReducedSystem& system, const std::vector<int>& places,
                     const std::vector<std::string>& fixed, const ModeRange& range)
{
  HeldPairs held{.pairs = {.X = {0, 0}, .lambda = {}}, .n_rigid = 0};
  on_first_rank([&] {
    const mbs_export::HeldModeShapes shapes = mbs_export::held_mode_shapes(
        system, fixed, {.lambda_max = range.omega_max * range.omega_max, .most = range.most});
    held.pairs = to_model_order(shapes, places, range);
    held.n_rigid = shapes.n_free_rigid;
  });
  held.pairs = broadcast(std::move(held.pairs));
  return held;
}

Certified certify(const mbs_export::ReducedSystem& system, const Reduction& reduction,
                  const std::vector<std::string>& fixed, const ModeRange& range,
                  reduce::Purpose purpose)
{
  const HeldPairs held = held_pairs(system, reduction.places, fixed, range);
  reduce::ErrorEstimates errors = reduce::error_estimates(
      {.K_ss = reduction.K_ss, .Q_CB = reduction.Q_CB, .K = reduction.K, .M = reduction.M},
      held.pairs, purpose);
  const auto as_vector = [](const std::vector<double>& values) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)));
  };
  mbs_export::Certificate certificate;
  certificate.fixed = fixed;
  certificate.n_rigid = held.n_rigid;
  on_first_rank([&] { certificate.rigid_residual = mbs_export::rigid_residual(system); });
  certificate.frequencies = as_vector(held.pairs.lambda).cwiseSqrt();
  certificate.eta2 = as_vector(errors.eta2);
  certificate.estimates = as_vector(
      reduce::frequency_errors_by_place(held.pairs.lambda, errors.eta2, reduction.lambda_left_out));
  certificate.rounding = as_vector(errors.rounding);
  return {.certificate = std::move(certificate), .residuals = std::move(errors.inner_products)};
}

HeldSpectrum held_spectrum(const mbs_export::ReducedSystem& system)
{
  HeldSpectrum spectrum{.lambda = {}, .n_rigid = 0, .held_rows = {}};
  on_first_rank([&] {
    const std::vector<std::string>& fixed = system.certificate.fixed;
    const mbs_export::HeldModeShapes held = mbs_export::held_mode_shapes(system, fixed);
    for (const double omega : held.omega) spectrum.lambda.push_back(omega * omega);
    spectrum.n_rigid = held.n_rigid;
    spectrum.held_rows = mbs_export::held_dofs(system, fixed).rows;
  });
  broadcast(spectrum.lambda);
  broadcast(spectrum.held_rows);
  MPI_Bcast(&spectrum.n_rigid, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return spectrum;
}

}  // namespace chladni::cli
