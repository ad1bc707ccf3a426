#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "squeal/assembly/part.hpp"

namespace chladni::squeal {

/// Components of a motion in the axes of the brake: x, y, z, rx, ry, rz.
using Components = std::array<bool, 6>;

/// What a point must have of its node to move by these components itself.
/// @param arm        from the node to the point, m
/// @param tolerance  of places of nodes, m
Components needed_of_node(const Components& of_point, const Eigen::Vector3d& arm, double tolerance);

/// The modes of a part move the nodes of a set in these components.
/// @param key     of the scene: "contact[2].face"
/// @param remedy  what to do, for the message
/// @throws chladni::Error naming key, component, part, file and set, where the body lacks one at
///         all of these nodes, or where a node that moves has no rotations.
void require_components(const Part& part, const std::string& set, const Components& needed,
                        const std::string& key, const std::string& remedy);

/// None of these components is the rotation about the normal of a smooth shell at a node of the
/// set, nor has a share of it.
/// @throws chladni::Error naming key, component, part, file and set.
void refuse_drilling(const Part& part, const std::string& set, const Components& components,
                     const std::string& key);

/// Axes about which two nodes may be joined: [3 x 0 to 3] an orthonormal basis of what is normal to
/// the normals of shells there.
/// @param normals  a column for each node, zero for none
Eigen::Matrix3Xd axes_without_drilling(const Eigen::Matrix<double, 3, 2>& normals);

}  // namespace chladni::squeal
