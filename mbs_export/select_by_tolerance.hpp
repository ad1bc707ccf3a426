#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/response_error.hpp"

namespace chladni::mbs_export {

/// The modes and interface modes that a tolerance asks for.
struct ToleranceSelection {
  std::vector<int> kept;                   ///< ascending
  std::vector<int> neglected;              ///< all others, ascending
  std::vector<InterfaceChoice> interface;  ///< patterns over the loads
  SelectionTable table;                    ///< its last rows tell whether the tolerance is met
};

/// Chooses greedily among the modes of a held body and the interface modes of its loads, so that
/// the responses at the loads differ from those of all modes by less than the tolerance anywhere in
/// the range. A step adds what lowers most, for each mode it costs, the logarithm of the error
/// above the tolerance, summed over frequencies and loads: a cluster of modes, or the interface
/// modes of one group of loads at the frequency of the largest error or at the lower end. Rigid
/// modes and excited resonances of the range are always modes of their own. The choice is compared
/// with modes alone and the smaller one wins. A tolerance below round-off is not met; then the
/// choice is the best there is.
/// @param omega  [n] frequencies of the held body, rad/s, ascending
/// @param B      [n x m] its mode shapes at the rows of `loads`
ToleranceSelection select_by_tolerance(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                       const LoadedDofs& loads, const Tolerance& tolerance);

}  // namespace chladni::mbs_export
