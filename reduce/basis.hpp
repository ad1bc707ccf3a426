#pragma once

#include <limits>
#include <optional>

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// Whether the modes are those of the body with free masters, which need all of K and M: the mixed
/// interface, Rubin's, MacNeal's, and what may become one of them.
bool has_free_masters(Method method);

/// What the methods with free masters see of a body, which must outlive it.
WholeSystem whole_system(const FactoredBody& body);

/// The columns of the transformation of a method.
struct Basis {
  CraigBamptonBasis Q;
  std::optional<Eigen::MatrixXd> mass = {};  ///< M_r where the method does not project it
  /// Up to here the basis has the modes of the supported body themselves, rad/s; 0 where it has not
  double exact_up_to = 0.0;
  /// The first eigenvalue under the support whose mode it has not, rad^2/s^2; infinite where
  /// unknown
  double lambda_left_out = std::numeric_limits<double>::infinity();
};

/// By the method of the options: the one place that tells the methods apart. Its last phase is
/// still under way at its end.
/// @param support  under which a tolerance is kept
/// @note   Collective.
Basis make_basis(const FactoredBody& body, const ReductionOptions& options, const Support& support,
                 PhaseListener& phases);

/// The lowest elastic modes of a method by number, rad/s, ascending: fixed-interface modes or those
/// of the body that the support holds or nothing.
/// @note   Collective.
/// @throws chladni::Error when there are not as many.
std::vector<double> lowest_modes(const FactoredBody& body, const ReductionOptions& options,
                                 const Support& support);

}  // namespace chladni::reduce
