#pragma once

#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::formats {

/// A number for each attachment node: its own, if that is in 1 .. largest and no earlier node has
/// it, else the smallest number that no node has.
/// @throws chladni::Error when there are more nodes than numbers.
std::vector<int> unique_node_numbers(const std::vector<AttachmentNode>& nodes, int largest);

}  // namespace chladni::mbs_export::formats
