#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Makes a mesh the first of `count` equal sectors about the z axis. Finds the nodes of its cut
/// edges, of solids of its cut faces, which a turn by 360 degrees / count takes onto each other,
/// and moves those of the second edge exactly there. The edges may be curved. Nodes on the axis
/// have no partner.
/// @param count  1: the mesh is the whole body and stays as it is
/// @throws chladni::Error when no node has a partner, when nodes of the cut edges do not match
///         (with the largest distance), and when the mesh is wider than one sector.
void find_sector_edges(Mesh& mesh, int count);

/// Checks that a generator makes all sectors equal.
/// @throws chladni::Error when count > 1 and the pattern is not structured.
void check_pattern_of_sectors(int count, Pattern pattern);

/// The point that corresponds to x, m, in the sector that follows by `turns` turns.
std::array<double, 3> turned(const Sectors& sectors, const std::array<double, 3>& x, int turns = 1);

/// True if x, m, is on the z axis to the precision of a mesh file of a body of this `length`, m.
bool is_on_axis(const std::array<double, 3>& x, double length);

/// The largest distance of a node from the z axis, m.
double outer_radius(const Mesh& mesh);

/// The largest N for which a turn by 360 degrees / N about the z axis takes nodes, elements and
/// groups of a whole body to nodes, elements and groups; 1 if there is no such symmetry.
int n_repetitions(const Mesh& mesh);

/// One of the equal sectors of a periodic mesh. Of each element and its turned copies it holds the
/// one with the least angle, measured from the x axis or from a plane that makes the sector its own
/// mirror image. The cut follows the sides of elements.
/// @param count  number of sectors: `n_repetitions` or a divisor of it
/// @throws chladni::Error for a mesh without this symmetry.
Mesh one_sector(const Mesh& mesh, int count);

}  // namespace chladni::mesh
