#pragma once

#include "linear/cholesky/cholesky_factor.hpp"
#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// `Support::modes` of the first rank on all ranks.
/// @note   Collective.
SupportedModes modes_everywhere(const Support& support, const ReducedModel& model,
                                const SpectrumRange& wanted, MPI_Comm comm);

/// The modes that get an error: with a tolerance all up to its range, else up to the last
/// fixed-interface mode, at most 100; without these modes the first 20.
SpectrumRange certified_range(const ReduceOptions& options, const ReducedModel& model);

/// The modes of a range, at least one where there is one.
ReducedPairs leading_pairs(const SupportedModes& modes, const SpectrumRange& range);

/// Whether the eigenvalues of the FE model are counted.
class CountPlan {
 public:
  CountPlan(const FactoredBody& body, const ReductionOptions& options);

  /// The count as a share of the reduction with a number of fixed-interface modes.
  double share(PetscInt n_modes) const;
  /// False where it is known before there is a basis that nothing will be counted.
  bool is_possible() const;
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

/// What an elimination takes whose columns are not kept, in multiples of the entries of a factor.
/// Where MUMPS has to count, which keeps a factor with pivoting and copies of the matrix, it is 4.4
/// times the entries; whether it will have to is not known before.
inline constexpr double entries_of_counting_factor = 1.0;

/// What a reduction has found.
struct Reduced {
  const FactoredBody& body;
  const CraigBamptonBasis& Q_CB;
  const ReducedModel& model;
  bool is_projected;  ///< M_r = Q_CB^T M Q_CB: residuals mean nothing without
};

/// A certificate on its way.
struct Certified {
  Certificate certificate;
  SupportedModes modes;
  Eigen::MatrixXd residuals = {};  ///< `ErrorEstimates::inner_products`; empty but for bounds
};

/// The error estimates of the modes of a range.
/// @note   Collective, as the next.
Certified estimated(const Reduced& reduced, const ReductionOptions& options, const Support& support,
                    Purpose purpose);

/// With the eigenvalues of the FE model counted, and bounds in the range where none is missing.
Certificate counted(Certified certified, const Reduced& reduced, const ReductionOptions& options,
                    const Support& support);

}  // namespace chladni::reduce
