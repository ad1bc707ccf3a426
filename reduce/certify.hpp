#pragma once

#include "linear/cholesky/cholesky_factor.hpp"
#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// Computes `Support::modes` on the first rank and sends the result to all ranks.
/// @note   Collective.
SupportedModes modes_everywhere(const Support& support, const ReducedModel& model,
                                const SpectrumRange& wanted, MPI_Comm comm);

/// The modes that get an error estimate. With a tolerance these are all modes up to its frequency;
/// else those up to `certified_up_to_Hz`, or up to the last mode of the basis, at most 100; without
/// modes in the basis the lowest 20.
SpectrumRange certified_range(const ReduceOptions& options, const ReducedModel& model);

/// The modes that lie in a range. If none does, the first mode is returned, where there is one.
ReducedPairs leading_pairs(const SupportedModes& modes, const SpectrumRange& range);

/// Decides whether the eigenvalues of the FE model are counted.
class CountPlan {
 public:
  CountPlan(const FactoredBody& body, const ReductionOptions& options);

  /// Predicted share of the counts in the work of a reduction with this many modes, 0 to 1.
  double share(PetscInt n_modes) const;
  /// False where it is certain, before there is a basis, that nothing will be counted.
  bool is_possible() const;
  /// True when a count is wanted for a basis of this many modes and its factor fits into the
  /// memory.
  /// @note   Collective.
  bool is_due(PetscInt n_modes) const;

 private:
  bool is_wanted(PetscInt n_modes) const;
  bool fits() const;

  ReduceOptions basis_;
  std::optional<bool> count_;
  linear::FactorSize factor_;
  double n_slaves_, n_masters_;
  MPI_Comm comm_;
};

/// Whether counts are cheap enough to be made unasked, by their predicted share of the work.
inline constexpr double cheap_share_of_counts = 0.1;

/// Predicted share of the counts in the work of a reduction, 0 to 1.
double share_of_counts(const linear::FactorSize& factor, double n_slaves, double n_masters,
                       double n_modes);

/// Memory of the elimination that counts eigenvalues and keeps no columns, in multiples of the
/// entries of a factor of K_ss. If MUMPS has to count, with pivoting, a kept factor and copies of
/// the matrix, it needs 4.4 times the entries; whether it has to is not known in advance.
inline constexpr double entries_of_counting_factor = 1.0;

/// A body with its basis and its projected model.
struct Reduced {
  const FactoredBody& body;
  const CraigBamptonBasis& Q_CB;
  const ReducedModel& model;
};

/// A certificate with error estimates, and what the count of eigenvalues needs further.
struct Certified {
  Certificate certificate;
  SupportedModes modes;
  /// `ErrorEstimates::inner_products`; set for Purpose::bounds only
  Eigen::MatrixXd residuals = {};
};

/// Estimates the errors of the modes of `certified_range`.
/// @note   Collective, as is `counted`.
Certified estimated(const Reduced& reduced, const ReductionOptions& options, const Support& support,
                    Purpose purpose);

/// Counts the eigenvalues of the FE model and adds the counts to the certificate, with error bounds
/// for the modes of a range in which none is missing.
Certificate counted(Certified certified, const Reduced& reduced, const ReductionOptions& options,
                    const Support& support);

}  // namespace chladni::reduce
