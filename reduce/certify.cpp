#include "reduce/certify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/all_ranks.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/cholesky/sylvester.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

void broadcast_values(std::vector<double>& values, MPI_Comm comm)
{
  auto n = static_cast<int>(values.size());
  MPI_Bcast(&n, 1, MPI_INT, 0, comm);
  values.resize(static_cast<std::size_t>(n));
  linear::broadcast_numbers(values, comm);
}

double zero_energy_everywhere(const Support& support, const ReducedModel& model,
                              const SupportedModes& modes, MPI_Comm comm)
{
  double energy = 0.0;
  on_first_rank(comm, [&] { energy = support.zero_energy(model, modes); });
  return linear::value_of_first_rank(energy, comm);
}

/// The lambda from which on fixed-interface modes are left out of the basis.
double lambda_left_out(const ReduceOptions& options, const ReducedModel& model)
{
  if (options.method != Method::craig_bampton) return std::numeric_limits<double>::infinity();
  return model.omega.empty() ? 0.0 : model.omega.back() * model.omega.back();
}

/// Those that are not held; how to eliminate the slaves is known from the factor of K_ss.
linear::CountedRows counted_rows(const FactoredBody& body, const Support& support)
{
  return {.held = support.held(), .factor = body.K_ss.factor(), .factored = all_slaves(body.dofs)};
}

/// Of a part of a body, whose range is that of the body, whatever the part has in it.
std::optional<double> end_of_counts(const ReduceOptions& options, const ReducedModel& model)
{
  const double lambda = certified_range(options, model).lambda_max;
  if (!options.may_have_none || !std::isfinite(lambda)) return std::nullopt;
  return lambda;
}

}  // namespace

SupportedModes modes_everywhere(const Support& support, const ReducedModel& model,
                                const SpectrumRange& wanted, MPI_Comm comm)
{
  SupportedModes modes;
  on_first_rank(comm, [&] { modes = support.modes(model, wanted); });
  std::array<int, 3> numbers{modes.are_all ? 1 : 0, modes.n_zero, modes.n_free_zero};
  MPI_Bcast(numbers.data(), 3, MPI_INT, 0, comm);
  modes.are_all = numbers[0] == 1;
  modes.n_zero = numbers[1];
  modes.n_free_zero = numbers[2];
  broadcast_values(modes.pairs.lambda, comm);
  if (petsc::rank(comm) != 0)
    modes.pairs.X = MatrixXd(model.K.rows(), std::ssize(modes.pairs.lambda));
  linear::broadcast_numbers(linear::values_of(modes.pairs.X), comm);
  return modes;
}

SpectrumRange certified_range(const ReduceOptions& options, const ReducedModel& model)
{
  constexpr PetscInt most = 100, without_modes = 20;  // bounds the block solve of the estimates
  // Copies of the last eigenvalue belong to the range whatever round-off makes of them.
  constexpr double same_value = 1.0 + 1e-9;
  const auto up_to = [](double omega) { return omega * omega * same_value; };
  if (options.tolerance)  // which holds for all of them
    return {.lambda_max = up_to(2.0 * std::numbers::pi * options.tolerance->up_to_Hz)};
  if (options.certified_up_to_Hz) {
    return {.lambda_max = up_to(2.0 * std::numbers::pi * *options.certified_up_to_Hz),
            .most = most};
  }
  if (model.omega.empty()) return {.most = without_modes};
  return {.lambda_max = up_to(model.omega.back()), .most = most};
}

ReducedPairs leading_pairs(const SupportedModes& modes, const SpectrumRange& range)
{
  const std::vector<double>& lambda = modes.pairs.lambda;
  const auto n_below =
      static_cast<PetscInt>(std::ranges::upper_bound(lambda, range.lambda_max) - lambda.begin());
  const auto k =
      std::min(std::clamp<PetscInt>(n_below, 1, range.most), static_cast<PetscInt>(lambda.size()));
  return {.X = modes.pairs.X.leftCols(k), .lambda = {lambda.begin(), lambda.begin() + k}};
}

Certified estimated(const Reduced& reduced, const ReductionOptions& options, const Support& support,
                    Purpose purpose)
{
  const FactoredBody& body = reduced.body;
  const SpectrumRange range = certified_range(options.basis, reduced.model);
  // A count needs all modes.
  const SpectrumRange wanted = purpose == Purpose::bounds ? SpectrumRange{} : range;
  Certified certified{.certificate = {},
                      .modes = modes_everywhere(support, reduced.model, wanted, body.comm())};
  Certificate& certificate = certified.certificate;
  ReducedPairs pairs = leading_pairs(certified.modes, range);
  if (!pairs.lambda.empty()) {
    ErrorEstimates errors = error_estimates(
        {.K_ss = body.K_ss, .Q_CB = reduced.Q_CB, .K = body.K_blocks, .M = body.M_blocks}, pairs,
        purpose);
    certificate.estimates = frequency_errors_by_place(
        pairs.lambda, errors.eta2, lambda_left_out(options.basis, reduced.model));
    certificate.eta2 = std::move(errors.eta2);
    certificate.rounding = std::move(errors.rounding);
    certified.residuals = std::move(errors.inner_products);
  }
  certificate.lambda = std::move(pairs.lambda);
  certificate.n_zero = certified.modes.n_free_zero;
  certificate.zero_energy =
      zero_energy_everywhere(support, reduced.model, certified.modes, body.comm());
  return certified;
}

Certificate counted(Certified certified, const Reduced& reduced, const ReductionOptions& options,
                    const Support& support)
{
  const FactoredBody& body = reduced.body;
  const linear::OptionSource& source = body.K_ss.options().petsc;
  Certificate certificate = std::move(certified.certificate);
  if (!certified.modes.are_all)
    certified.modes = modes_everywhere(support, reduced.model, {}, body.comm());
  Completeness found = count_modes(
      {.lambda = std::move(certified.modes.pairs.lambda),
       .residuals = std::move(certified.residuals),
       .n_zero = certified.modes.n_zero,
       .comm = body.comm(),
       .ends_at = end_of_counts(options.basis, reduced.model)},
      [&, rows = counted_rows(body, support)](double sigma) {
        return linear::eigenvalues_below(body.K, body.M, {sigma, gap_of_counts}, rows, source);
      });
  certificate.range = found.range;
  certificate.complete = found.complete;
  certificate.bounds = std::move(found.bounds);
  for (std::size_t i = 0; i < certificate.bounds.size(); ++i) {
    certificate.bounds[i] += certificate.rounding[i];
    // An estimate above its bound is known to be too high.
    certificate.estimates[i] = std::min(certificate.estimates[i], 0.5 * certificate.bounds[i]);
  }
  if (options.basis.method == Method::craig_bampton) {
    certificate.fixed_interface = count_fixed_interface(reduced.model.omega, [&](double sigma) {
      return linear::eigenvalues_below(body.K_blocks.ss, body.M_blocks.ss, {sigma, gap_of_counts},
                                       {.factor = body.K_ss.factor()}, source);
    });
  }
  return certificate;
}

CountPlan::CountPlan(const FactoredBody& body, const ReductionOptions& options)
    : basis_(options.basis),
      count_(options.count),
      factor_(linear::factor_size(body.K_ss.factor())),
      n_masters_(static_cast<double>(body.masters.size())),
      comm_(body.comm())
{
  PetscInt n = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n, nullptr));
  n_slaves_ = static_cast<double>(n);
}

double share_of_counts(const linear::FactorSize& factor, double n_slaves, double n_masters,
                       double n_modes)
{
  // Two counts are made, each by an order, an elimination without a factor and K - sigma M, which
  // together take two to three times as long as the operations of a factor do. Block Lanczos takes
  // 3.2 vectors for each mode.
  constexpr double of_both_counts = 5.0, vectors_for_mode = 3.2;
  const double n_vectors = vectors_for_mode * n_modes;
  const double solutions = 4.0 * factor.entries * (0.5 * n_masters + n_vectors + n_modes);
  const double products =
      n_slaves * (n_masters * n_masters + 2.0 * n_masters * n_modes + 2.0 * n_vectors * n_vectors);
  const double count = of_both_counts * factor.operations;
  return count / (count + factor.operations + solutions + products);
}

double CountPlan::share(PetscInt n_modes) const
{
  return share_of_counts(factor_, n_slaves_, n_masters_, n_modes);
}

bool CountPlan::is_wanted(PetscInt n_modes) const
{
  return count_.value_or(share(n_modes) < cheap_share_of_counts);
}

bool CountPlan::is_possible() const
{
  if (basis_.method == Method::guyan) return is_wanted(0);
  return basis_.modes ? is_wanted(*basis_.modes) : count_.value_or(true);
}

bool CountPlan::fits() const
{
  if (count_) return true;  // and the factor was refused else
  const double own_MiB = sizeof(double) * entries_of_counting_factor * factor_.entries /
                         petsc::size(comm_) / linear::bytes_in_MiB;
  return linear::tightest_machine(own_MiB, linear::free_MiB(), comm_).fits();
}

bool CountPlan::is_due(PetscInt n_modes) const
{
  return is_wanted(n_modes) && fits();
}

}  // namespace chladni::reduce
