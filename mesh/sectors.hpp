#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Makes a mesh the first of `count` equal sectors about the z axis: finds the nodes of its cut
/// edges, which a turn by 360 degrees / count takes onto each other, and moves those of the second
/// edge exactly there. The edges may be curved. Nodes on the axis have no partner.
/// @param count  1: the mesh is the whole body, and nothing happens
/// @throws chladni::Error when no node has a partner, when nodes of the cut edges do not meet, with
///         the worst distance, and when the mesh is wider than one sector.
void find_sector_edges(Mesh& mesh, int count);

/// @throws chladni::Error when generated elements are not the same in all sectors.
void check_pattern_of_sectors(int count, Pattern pattern);

/// The point that `turns` sectors further on corresponds to x.
std::array<double, 3> turned(const Sectors& sectors, const std::array<double, 3>& x, int turns = 1);

/// Whether a point is on the z axis, to the precision of a mesh file of this size, m.
bool is_on_axis(const std::array<double, 3>& x, double length);

/// A length that is large beside the mesh's round-off: its largest distance from the z axis, m.
double outer_radius(const Mesh& mesh);

}  // namespace chladni::mesh
