#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

/// A unit load that some nodes share equally, or the motion of one node.
struct ResponseDof {
  std::string name;  ///< "tip.z", or "track.z (node 17)" of a set of several nodes
  std::string key;   ///< key of the scene's table [response] that asks for it, "loads[1].dofs"
  int component;     ///< 0 to 5
  std::vector<int> nodes;                          ///< places in NamedNodes::nodes
  std::optional<std::int64_t> measured_node = {};  ///< number of the node in a measurement
};

/// The attachment nodes and sets of a model.
struct NamedNodes {
  const std::vector<AttachmentNode>& nodes;
  const std::vector<AttachmentSet>& sets;
};

/// One load for each component of each place. The nodes of its set share the unit equally, or the
/// node nearest to `near` bears it alone.
/// @throws ResponseOptionError for an unknown or empty set, two nodes equally near, a load that is
///         named twice, and a moment about a drilling axis.
std::vector<ResponseDof> response_loads(const NamedNodes& model,
                                        const std::vector<ResponsePlace>& places);

/// One output for each node and component.
/// @throws ResponseOptionError for an unknown or empty set, two nodes equally near, and an output
///         that is named twice, and one measured node for several nodes. Drilling rotations are
///         allowed.
std::vector<ResponseDof> response_outputs(const NamedNodes& model,
                                          const std::vector<ResponsePlace>& places);

}  // namespace chladni::mbs_export
