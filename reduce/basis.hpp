#pragma once

#include <optional>

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// Rubin's and MacNeal's.
bool is_free_interface(Method method);

/// The columns of the transformation of a method.
struct Basis {
  CraigBamptonBasis Q;
  std::optional<Eigen::MatrixXd> mass = {};  ///< M_r where the method does not project it
};

/// By the method of the options: the one place that tells the methods apart. Its last phase is
/// still under way at its end.
/// @param support  under which a tolerance is kept
/// @note   Collective.
Basis make_basis(const FactoredBody& body, const ReductionOptions& options, const Support& support,
                 PhaseListener& phases);

}  // namespace chladni::reduce
