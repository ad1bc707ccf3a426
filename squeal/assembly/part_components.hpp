#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "squeal/assembly/part.hpp"

namespace chladni::squeal {

/// Flags for the components x, y, z, rx, ry, rz of a motion in the axes of the brake.
using Components = std::array<bool, 6>;

/// The components that a node must have so that a point rigidly connected to it has the components
/// `of_point`.
/// @param arm        vector from the node to the point, m
/// @param tolerance  error of node positions, m
Components needed_of_node(const Components& of_point, const Eigen::Vector3d& arm, double tolerance);

/// Checks that the modes of a part move the nodes of a set in these components.
/// @param key     key of the scene for messages, such as "contact[2].face"
/// @param remedy  what to do, for the message
/// @throws chladni::Error naming key, component, part, file and set, when the body lacks a
///         component at all of these nodes, or when a node that moves has no rotations.
void require_components(const Part& part, const std::string& set, const Components& needed,
                        const std::string& key, const std::string& remedy);

/// Checks that none of these components contains a rotation about the normal of a smooth shell at a
/// node of the set.
/// @throws chladni::Error naming key, component, part, file and set.
void refuse_drilling(const Part& part, const std::string& set, const Components& components,
                     const std::string& key);

/// Axes about which the rotations of two nodes may be joined: an orthonormal basis of the
/// directions perpendicular to the shell normals there.
/// @param normals  one column for each node, zero for none
/// @return [3 x 0 to 3]
Eigen::Matrix3Xd axes_without_drilling(const Eigen::Matrix<double, 3, 2>& normals);

}  // namespace chladni::squeal
