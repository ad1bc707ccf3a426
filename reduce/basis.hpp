#pragma once

#include <limits>

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// True for the methods whose modes are those of the body with free masters and which therefore
/// need all of K and M: the mixed interface, Rubin's, and `automatic`, which may become the mixed
/// interface.
bool has_free_masters(Method method);

/// @throws chladni::Error when a tolerance is wanted of a method that cannot keep one.
void refuse_unkept_tolerance(const ReduceOptions& wanted);

/// The view of a body that the methods with free masters work on. The body must outlive it.
WholeSystem whole_system(const FactoredBody& body);

/// The basis that a method makes.
struct Basis {
  CraigBamptonBasis Q;
  /// rad/s; up to here the basis holds the modes of the supported body themselves. 0: it holds
  /// none.
  double exact_up_to = 0.0;
  /// rad^2/s^2; first eigenvalue of the supported body whose mode the basis lacks; infinity:
  /// unknown
  double lambda_left_out = std::numeric_limits<double>::infinity();
};

/// Makes the basis by the method of the options. Only this function and `lowest_modes` tell the
/// methods apart. The last phase is still open when it returns.
/// @param support  the tolerance of the options applies to the body under this support
/// @note   Collective.
Basis make_basis(const FactoredBody& body, const ReductionOptions& options, const Support& support,
                 PhaseListener& phases);

/// Frequencies of the lowest elastic modes that the options ask for by number, without a reduction:
/// fixed-interface modes, or modes of the body under the support, or of the free body, by the
/// method.
/// @return rad/s, ascending
/// @note   Collective.
/// @throws chladni::Error when the body has fewer modes.
std::vector<double> lowest_modes(const FactoredBody& body, const ReductionOptions& options,
                                 const Support& support);

/// The method that is asked for. For `automatic`, the one of Craig-Bampton and mixed interface
/// whose eigen-solve is predicted to need fewer operations, with the numbers that decided.
/// @note   Collective.
/// @throws chladni::Error when `automatic` has no tolerance.
MethodChoice method_choice(const FactoredBody& body, const ReductionOptions& options,
                           const Support& support);

}  // namespace chladni::reduce
