#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The loads of a tolerance on responses, and the sizes that their errors are relative to.
struct ResponseSizes {
  std::vector<int> rows;           ///< [m] loaded masters
  std::vector<std::string> names;  ///< "track.z" for all nodes of a set
  Eigen::VectorXd unit;            ///< [m] scales that make forces and moments comparable
  Eigen::VectorXd Omega;  ///< [g + 1] rad/s, the ends of bands from 0 to the end of the range
  /// [m x g] What the size of the responses to a load, scaled by `unit`, is not below in a band.
  Eigen::MatrixXd size;
};

/// The sizes of the responses of a reduced system.
/// @param options  with a tolerance in `keep`
/// @throws chladni::Error as `make_body`, and when a load acts on no master.
ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options);

struct ReferenceResponse;

/// The bands and sizes of known responses; rows and names stay empty.
ResponseSizes response_sizes(const ReferenceResponse& reference, const Tolerance& tolerance);

}  // namespace chladni::mbs_export
