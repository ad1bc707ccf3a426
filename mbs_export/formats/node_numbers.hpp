#pragma once

#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::formats {

/// The number of each attachment node where that is 1 .. largest and no earlier node has it, else
/// the least one that no node has.
/// @throws chladni::Error when there are more nodes than numbers.
std::vector<int> unique_node_numbers(const std::vector<AttachmentNode>& nodes, int largest);

}  // namespace chladni::mbs_export::formats
