#include "reduce/basis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/machine_memory.hpp"
#include "reduce/certify.hpp"
#include "reduce/mixed_interface.hpp"
#include "reduce/static_condensation.hpp"
#include "reduce/support.hpp"
#include "reduce/tolerance_search.hpp"

namespace chladni::reduce {

namespace {

petsc::Matrix constraint_modes_of(const FactoredBody& body, PhaseListener& phases)
{
  phases.begin("constraint modes");
  petsc::Matrix Psi = constraint_modes(body.K_ss, body.K_blocks);
  if (body.R == nullptr) return Psi;
  return with_rigid_motions(std::move(Psi), {.R = body.R, .dofs = body.dofs, .K = body.K_blocks});
}

/// As few fixed-interface modes as keep the tolerance.
FixedInterfaceModes modes_to_tolerance(const FactoredBody& body, Mat Psi,
                                       const ReductionOptions& options, const Support& support,
                                       PhaseListener& phases)
{
  // Frequencies of too few modes are too high: some beyond the range belong into it.
  constexpr double beyond = 1.25;
  // What the estimates from the small matrices and those from the FE model may differ by.
  constexpr double margin = 0.99;
  const ModesByTolerance& wanted = *options.basis.tolerance;
  ReduceOptions further = options.basis;
  further.tolerance->up_to_Hz *= beyond;
  ToleranceSearch search(
      {.K_ss = body.K_ss, .Psi = Psi, .K = body.K_blocks, .M = body.M_blocks},
      {.tolerance = margin * wanted.tolerance, .up_to_Hz = wanted.up_to_Hz},
      [&](const ReducedModel& model) {
        const SpectrumRange range = certified_range(further, model);
        return leading_pairs(modes_everywhere(support, model, range, body.comm()), range);
      },
      body.require_memory);
  do {
    phases.begin("fixed-interface modes");
    search.find_modes();
    phases.begin("choice of modes");
  } while (!search.is_enough());
  linear::give_back_freed();  // what the trials took, before the modes take as much again
  phases.begin("fixed-interface modes");
  return search.modes();
}

/// With a tolerance all modes of the responses' range too, and those near it that they still feel.
ReduceOptions with_modes_of_responses(const ReductionOptions& options)
{
  constexpr double beyond = 1.15;
  ReduceOptions wanted = options.basis;
  if (!options.responses || !wanted.tolerance) return wanted;
  const double f_Hz = beyond * options.responses->Omega / (2.0 * std::numbers::pi);
  wanted.tolerance->up_to_Hz = std::max(wanted.tolerance->up_to_Hz, f_Hz);
  return wanted;
}

std::vector<int> held_rows(const FactoredBody& body, const Support& support, Method method)
{
  if (method != Method::mixed_interface) return {};
  return rows_of_masters(body.masters, support.held());
}

/// Makes the basis of the modes of the body with some masters held or none.
Basis basis_of_own_modes(const FactoredBody& body, const ReductionOptions& options,
                         const Support& support, PhaseListener& phases)
{
  const Method method = options.basis.method;
  Basis basis{.Q = {.Psi = constraint_modes_of(body, phases), .modes = {}}};
  const WholeSystem whole = whole_system(body);
  phases.begin(method == Method::mixed_interface ? "mixed-interface modes"
                                                 : "free-interface modes");
  const MixedInterfaceModes modes = mixed_interface_modes(
      whole, basis.Q.Psi, with_modes_of_responses(options), held_rows(body, support, method));
  phases.begin("residual flexibility");
  if (modes.n_modes() > 0) basis.Q.modes = residual_modes(whole, modes);
  if (method == Method::mixed_interface) {
    basis.exact_up_to = modes.omega.empty() ? 0.0 : modes.omega.back();
    basis.lambda_left_out = modes.lambda_left_out;
  }
  return basis;
}

}  // namespace

std::vector<double> lowest_modes(const FactoredBody& body, const ReductionOptions& options,
                                 const Support& support)
{
  const ReduceOptions& wanted = options.basis;
  if (!has_free_masters(wanted.method))
    return fixed_interface_modes(body.K_ss, body.M_blocks.ss, wanted).omega;
  const petsc::Matrix Psi = constraint_modes(body.K_ss, body.K_blocks);
  const MixedInterfaceModes modes = mixed_interface_modes(whole_system(body), Psi, wanted,
                                                          held_rows(body, support, wanted.method));
  return {modes.omega.begin() + modes.n_rigid, modes.omega.end()};
}

WholeSystem whole_system(const FactoredBody& body)
{
  return {.K = body.K,
          .M = body.M,
          .dofs = body.dofs,
          .K_blocks = body.K_blocks,
          .M_blocks = body.M_blocks,
          .K_ss = body.K_ss};
}

void refuse_unkept_tolerance(const ReduceOptions& wanted)
{
  if (!wanted.tolerance || keeps_tolerances(wanted.method)) return;
  throw Error(fmt::format(
      "a tolerance was given to the method {}, which cannot keep one: its modes are not searched "
      "for by their errors; take auto, mixed-interface or craig-bampton, or give a number of modes "
      "or a cut-off",
      name_of(wanted.method)));
}

bool has_free_masters(Method method)
{
  return method != Method::guyan && method != Method::craig_bampton;
}

Basis make_basis(const FactoredBody& body, const ReductionOptions& options, const Support& support,
                 PhaseListener& phases)
{
  const ReduceOptions& wanted = options.basis;
  refuse_unkept_tolerance(wanted);
  if (has_free_masters(wanted.method)) return basis_of_own_modes(body, options, support, phases);
  Basis basis{.Q = {.Psi = {}, .modes = {}}};
  if (wanted.method == Method::guyan) {
    basis.Q.Psi = constraint_modes_of(body, phases);
  } else if (wanted.tolerance) {
    basis.Q.Psi = constraint_modes_of(body, phases);
    basis.Q.modes = modes_to_tolerance(body, basis.Q.Psi, options, support, phases);
  } else {  // the modes first: the subspace of the eigen-solver is as large as the constraint modes
    phases.begin("fixed-interface modes");
    basis.Q.modes = fixed_interface_modes(body.K_ss, body.M_blocks.ss, wanted, body.require_memory);
    basis.Q.Psi = constraint_modes_of(body, phases);
  }
  return basis;
}

namespace {

/// What a vector of the eigen-solve with free masters costs beside one with all of them held:
/// after the solution with the factor of K_ss the masters are let go, by K_G^-1 and Psi.
double cost_of_free_masters(const FactoredBody& body)
{
  // Products of dense matrices run at the rate of the processor, solutions at that of the memory.
  constexpr double dense_over_solution = 1.0 / 6.0;
  PetscInt n_slaves = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n_slaves, nullptr));
  const auto n_masters = double(body.masters.size());
  const double solution = 4.0 * linear::factor_size(body.K_ss.factor()).entries;
  const double product = 2.0 * n_masters * (double(n_slaves) + n_masters);
  return 1.0 + dense_over_solution * product / solution;
}

/// How many more fixed-interface modes than modes of the range keep a tolerance where masters are
/// free that the fixed interface holds: less than what was found on discs and beams (1.5 to 2.1 at
/// 1e-2, 1.6 to 7.5 at 1e-3, 2.5 to 16 at 1e-4), so that what is taken for cheaper is so.
double modes_beyond_range(double tolerance)
{
  constexpr double at_a_hundredth = 1.5;
  return at_a_hundredth * std::max(1.0, std::pow(1e-2 / tolerance, 0.25));
}

}  // namespace

MethodChoice method_choice(const FactoredBody& body, const ReductionOptions& options,
                           const Support& support)
{
  const ReduceOptions& wanted = options.basis;
  if (wanted.method != Method::automatic) return {.method = wanted.method};
  if (!wanted.tolerance) {
    throw Error(
        "reduce: an automatic choice of the method needs a tolerance; give a tolerance with its "
        "range, or a method");
  }
  const auto n_masters = double(body.masters.size());
  const double n_free = n_masters - double(support.held().size());
  if (n_free == 0.0) {
    return {.method = Method::craig_bampton,
            .reason = "the support holds all masters, as the fixed interface does"};
  }
  const double for_each_mode = cost_of_free_masters(body);
  const double more_modes = modes_beyond_range(wanted.tolerance->tolerance);
  if (for_each_mode <= more_modes) {
    return {
        .method = Method::mixed_interface,
        .reason = fmt::format("{:.0f} of {:.0f} masters are free: their modes cost {:.1f} times "
                              "as much as fixed-interface modes, of which at least {:.1f} times "
                              "as many would be needed",
                              n_free, n_masters, for_each_mode, more_modes)};
  }
  return {
      .method = Method::craig_bampton,
      .reason = fmt::format("with {:.0f} masters modes that leave them free cost {:.1f} times as "
                            "much as fixed-interface modes, of which {:.1f} times as many may do",
                            n_masters, for_each_mode, more_modes)};
}

}  // namespace chladni::reduce
