#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The loads of a tolerance on responses, and what errors of these are relative to.
struct ResponseSizes {
  std::vector<int> rows;           ///< [m] masters that are loaded
  std::vector<std::string> names;  ///< "track.z" stands for all nodes of the set
  Eigen::VectorXd unit;            ///< [m] that makes forces and moments commensurable
  Eigen::VectorXd Omega;           ///< [g] rad/s, a dozen up to the end of the range
  /// [m x g] of the responses to a load, in these units: the least from half-way to the frequency
  /// before to half-way to the next one.
  Eigen::MatrixXd size;
};

/// @param options  with a tolerance in `keep`
/// @throws chladni::Error as make_body, and where a load acts on no master.
ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options);

struct ReferenceResponse;

/// Frequencies and sizes alone, of responses that are known; no rows and names.
ResponseSizes response_sizes(const ReferenceResponse& reference, const Tolerance& tolerance);

}  // namespace chladni::mbs_export
