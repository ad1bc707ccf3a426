#pragma once

#include <span>
#include <string>

#include "cases/sector_model.hpp"

/// Checks that refuse, by name, what in a scene is not periodic or is not implemented for
/// harmonics.
namespace chladni::cases {

/// True if a node is on the z axis.
/// @param node  of the DofMap
bool is_on_axis(const SectorModel& model, int node);

/// Checks that the scene has nothing that is not implemented for harmonics.
/// @throws chladni::Error when it has.
void refuse_unsupported(const scene::Scene& scene);

/// True if a mass or a spring does not change under any turn about the z axis.
bool turns_with_sectors(const plate::PointMass& mass);
bool turns_with_sectors(const plate::Spring& spring);

/// Checks the averaging couplings. A coupling is allowed if each sector has a group of its own,
/// without nodes of the cut edges, which two sectors share; its reference node must be no interface
/// node.
/// @throws chladni::Error for another averaging coupling.
void check_means(const scene::Scene& scene, const SectorModel& model);

/// Checks that the nodes of a ring are equally spaced on one circle of the whole body.
/// @throws chladni::Error when they are not.
void check_ring(const SectorModel& model, const std::string& name,
                std::span<const SectorNode> nodes, const cyclic::Ring& ring);

/// Checks the deviations of single sectors.
/// @throws chladni::Error for a deviating mass or spring on the axis or on a cut edge, and for
///         section forces of a group whose section deviates.
void check_deviations(const scene::Scene& scene, const SectorModel& model);

}  // namespace chladni::cases
