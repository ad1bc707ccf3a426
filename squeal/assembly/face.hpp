#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include "squeal/assembly/joints.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {

/// A node of a lining on the disc.
struct FaceNode {
  int node;       ///< index of the node in the part
  double height;  ///< height of the node above the contact plane, m
  double angle;   ///< rad
  double sigma;   ///< 1 above the disc, -1 below it
  PadFace place;  ///< on the disc
  double share;   ///< fraction of the face's stiffness, damping and preload
  double area;    ///< m^2; 0 when the face has no area
  /// [n_rings] interpolation weights of the disc's rings at the node; their sum is 1.
  Eigen::VectorXd ring_parts;
};

/// Rings and contact planes of a disc.
struct DiscFaces {
  std::vector<RingPlace> rings;
  std::array<double, 2> planes;  ///< z of the lower and of the upper contact plane, m
  bool are_checked = true;       ///< whether a face must touch a plane, within the rings
};

/// The nodes of a face on the disc. The motion of the disc between its rings is interpolated by the
/// polynomial in r through the nearest rings, at most four; of a solid, through those of its face.
/// @param key  key of the scene for messages, such as "contact[2]"
/// @throws chladni::Error naming the key, for a set that the part does not have, a face that does
///         not touch a contact plane or lies beyond the rings (with the distance), nodes that
///         enclose no area, faces of more than half a turn, and bodies without displacements or
///         tilts there.
std::vector<FaceNode> face_nodes(const FaceContact& contact, const Part& part,
                                 const DiscFaces& disc, const std::string& key);

/// Contact planes of the disc and its rings.
/// @throws chladni::Error when the rings lie at more than two heights, or two of one height have
///         the same radius.
DiscFaces disc_faces(const AssemblyOptions& options, const InertialDisc& disc);

/// Motion of the disc at a node for each mode: [n x 3 or 5] W, W_r, W_t and, if used, V_r, V_t.
Eigen::MatrixXd disc_shapes(const InertialDisc& disc, const FaceNode& node);

/// Motion (r, t, z) of the part's face at a node for each mode of the part, [n x 3].
Eigen::MatrixX3d face_motion(const Part& part, const FaceNode& node);

/// Area of a face around the z axis that belongs to each node: the part of the outline that is
/// nearer to this node than to any other. The outline is the convex hull of the nodes in (x, y),
/// which is exact for a straight plate, or in (r, R theta) with the mean radius R, which is exact
/// for a sector of a ring; the smaller hull is taken, and distances are measured in its plane. A
/// grid of circles and radii gets the areas of the trapezoidal rule.
/// @param radii   [n] m
/// @param angles  [n] rad, less than half a turn apart
/// @return [n] m^2; zeros when all nodes lie on one line or circle
Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles);

/// Derivatives of the contact force at a point by its motion and its rates about the sliding
/// equilibrium.
struct FaceDerivatives {
  Eigen::MatrixXd by_motion;  ///< [rows x rows]
  Eigen::MatrixXd by_rate;    ///< [rows x rows]
};

/// Contact derivatives of a pad above (sigma = 1) or below (sigma = -1) the disc, by complex steps.
/// Rows are those of the disc, then (r, t, z) of the pad.
/// @param rows   6 on a middle surface, 8 with in-plane displacements
/// @param speed  rad/s, > 0
FaceDerivatives face_derivatives(const PadContact& pad, double sigma, int rows, double speed);

}  // namespace chladni::squeal
