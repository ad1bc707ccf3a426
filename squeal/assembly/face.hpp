#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "squeal/assembly/part.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {

/// A node of a lining on the disc.
struct FaceNode {
  int node;                    ///< of the part
  double height;               ///< of the node above the contact plane, m
  double angle;                ///< rad
  double sigma;                ///< 1 above the disc, -1 below it
  PadFace place;               ///< on the disc
  double share;                ///< of stiffness, damping and preload of the face; all sum to 1
  double area;                 ///< m^2, 0 where the face has none
  Eigen::VectorXd ring_parts;  ///< [n_rings] of what the rings of the disc do there; they sum to 1
};

/// Where the disc may be touched.
struct DiscFaces {
  std::vector<RingPlace> rings;
  std::array<double, 2> planes;  ///< z of the lower and of the upper contact plane, m
};

/// The nodes of a face on the disc. The disc does between its rings what the polynomial in r
/// through the nearest four of them says.
/// @param key  of the scene: "contact[2]"
/// @throws chladni::Error naming the key, for a set that the part does not have, a face that does
///         not touch a contact plane or lies beyond the rings (by how much), nodes without
///         area, faces of more than half a turn, and bodies without displacements or tilts
///         there.
std::vector<FaceNode> face_nodes(const FaceContact& contact, const Part& part,
                                 const DiscFaces& disc, const std::string& key);

/// Contact planes of the disc and its rings.
/// @throws chladni::Error when rings lie at two heights, or two of them on one circle.
DiscFaces disc_faces(const AssemblyOptions& options, const InertialDisc& disc);

/// [n x 3 or 5] W, W_r, W_t, V_r, V_t of the disc under a node.
Eigen::MatrixXd disc_shapes(const InertialDisc& disc, const FaceNode& node);

/// [n x 3] motion (r, t, z) of the face of the part at a node, one row for each mode of the part.
Eigen::MatrixX3d face_motion(const Part& part, const FaceNode& node);

}  // namespace chladni::squeal
