#pragma once

#include <span>
#include <string>

#include "cases/sector_model.hpp"

/// What of a scene does not repeat with its sectors, or is not known of harmonics: refused by name.
namespace chladni::cases {

/// @param node  of the DofMap
bool is_on_axis(const SectorModel& model, int node);

/// @throws chladni::Error for what harmonics do not know yet.
void refuse_unsupported(const scene::Scene& scene);

/// The mean of a group is one of each sector where each sector has a group of its own: the cut
/// edges, whose nodes two sectors share, have none of it. A mean is no interface node of a sector.
/// @throws chladni::Error for another mean.
void check_means(const scene::Scene& scene, const SectorModel& model);

/// @throws chladni::Error for nodes that are not equally spaced on one circle of the whole body.
void check_ring(const SectorModel& model, const std::string& name,
                std::span<const SectorNode> nodes, const cyclic::Ring& ring);

}  // namespace chladni::cases
