#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/response_error.hpp"

namespace chladni::mbs_export {

/// The modes and interface modes that a tolerance asks for.
struct ToleranceSelection {
  std::vector<int> kept;                   ///< ascending
  std::vector<int> neglected;              ///< all others, ascending
  std::vector<InterfaceChoice> interface;  ///< patterns over the loads
  SelectionTable table;                    ///< its last rows show whether the tolerance is met
};

/// Chooses greedily among the modes of a held body and the interface modes of its loads, until the
/// responses at the loads differ from those of all modes by less than the tolerance anywhere in the
/// range. The measure is the logarithm of the error above the tolerance, summed over frequencies
/// and loads. Each step adds the candidate that lowers it most per mode added: a cluster of modes,
/// or the interface modes of one group of loads at the frequency of the largest error or at the
/// lower end of the range. Rigid modes and excited resonances of the range are always kept as
/// modes. The choice is compared with one of modes alone, and the smaller one is returned. If a
/// tolerance is below round-off and cannot be met, the best choice is returned.
/// @param omega  [n] frequencies of the held body, rad/s, ascending
/// @param B      [n x m] its mode shapes at the rows of `loads`
ToleranceSelection select_by_tolerance(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                       const LoadedDofs& loads, const Tolerance& tolerance);

/// The loads of a tolerance on responses, and the sizes that their errors are relative to.
struct ResponseSizes {
  std::vector<int> rows;           ///< loaded masters
  std::vector<std::string> names;  ///< LoadedDofs::names
  Eigen::VectorXd unit;            ///< [m] scales that make forces and moments comparable
  Eigen::VectorXd Omega;  ///< [g + 1] rad/s, the ends of bands from 0 to the end of the range
  /// [m x g] What the size of the responses to a load, scaled by `unit`, is not below in a band.
  Eigen::MatrixXd size;
  Eigen::MatrixXd spread = {};  ///< [n_rows x m] LoadedDofs::spread
};

/// The sizes of the responses of a reduced system.
/// @param options  with a tolerance in `keep`
/// @throws chladni::Error as `make_body`, and when a load acts on no master.
ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options);

struct ReferenceResponse;

/// The bands and sizes of known responses; rows and names stay empty.
ResponseSizes response_sizes(const ReferenceResponse& reference, const Tolerance& tolerance);

}  // namespace chladni::mbs_export
