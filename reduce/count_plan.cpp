#include "linear/cholesky/cholesky_types.hpp"
#include "linear/machine_memory.hpp"
#include "reduce/certify.hpp"

namespace chladni::reduce {

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
