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

/// Whether a mass or a spring is the same after any turn about the z axis.
bool turns_with_sectors(const plate::PointMass& mass);
bool turns_with_sectors(const plate::Spring& spring);

/// The mean of a group is one of each sector where each sector has a group of its own: the cut
/// edges, whose nodes two sectors share, have none of it. A mean is no interface node of a sector.
/// @throws chladni::Error for another mean.
void check_means(const scene::Scene& scene, const SectorModel& model);

/// @throws chladni::Error for nodes that are not equally spaced on one circle of the whole body.
void check_ring(const SectorModel& model, const std::string& name,
                std::span<const SectorNode> nodes, const cyclic::Ring& ring);

/// @throws chladni::Error for a deviating mass or spring that stands on the axis or on a cut edge,
///         and for section forces of a group whose section deviates.
void check_deviations(const scene::Scene& scene, const SectorModel& model);

}  // namespace chladni::cases
