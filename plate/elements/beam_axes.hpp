#pragma once

#include <Eigen/Core>
#include <vector>

#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The local axes e_x, e_y, e_z of a beam as rows.
/// @param along  its direction, of any length, m
/// @throws chladni::Error when `along` vanishes, or when y and z of the section differ and its
///         orientation is missing or parallel to the beam.
Eigen::Matrix3d beam_axes(const Eigen::RowVector3d& along, const BeamSection& section);

/// True if the nodes lie on their chord at equal distances.
/// @param x  [n x 3] nodes from end to end, m
bool is_straight(const NodeVectors& x);

/// The section with an orientation along the whole of a curved line: its own, or where it has none
/// and needs none the normal of the plane of the line, nearer to the global +z than to -z.
/// @param x  [n x 3] nodes from end to end, m
BeamSection oriented(const BeamSection& section, const NodeVectors& x);

/// The local axes at each node of a line, whose axis is the polynomial through its nodes.
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `beam_axes`, also where the axes are not defined inside the line.
std::vector<Eigen::Matrix3d> node_axes(const NodeVectors& x, const BeamSection& section);

}  // namespace chladni::plate
