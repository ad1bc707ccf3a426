#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/assembly_options.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {

/// Properties of the lining of a whole face.
struct Lining {
  double area;       ///< m^2; 0 when the nodes enclose none
  double stiffness;  ///< N/m
  double damping;    ///< N s/m
  double preload;    ///< N
  FrictionLaw friction;
  bool has_own_friction;  ///< false: the friction of the brake
};

/// A contact point between the disc and a part.
struct AssemblyPoint {
  std::size_t contact;  ///< index of its lining
  double sigma;         ///< 1 above the disc, -1 below it
  PadFace place;
  double share, area;  ///< fractions of the lining's properties, and the point's area in m^2
  /// [n x rows] motion of the point by each coordinate: (w, g_r, g_t) or (w, g_r, g_t, v_r, v_t) of
  /// the disc, then (r, t, z) of the face.
  Eigen::MatrixXd S;
};

/// A disc between parts on their joints, in the inertial frame, without contact forces. The
/// coordinates are those of the disc, then the modes of the joined parts,
/// b'' + C b' + diag(omega^2) b = f. All are measured from the sliding equilibrium, in which the
/// preload of each lining is distributed like its area.
struct Assembly {
  InertialDisc disc;
  Eigen::VectorXd omega;  ///< [n_b] rad/s; 0 for motions that only linings hold
  Eigen::MatrixXd K;      ///< [n_b x n_b] 1/s^2, diag(omega^2), but see `neighbour`
  Eigen::MatrixXd C;      ///< [n_b x n_b] 1/s
  Eigen::MatrixXd X;      ///< [n x n_b] motions of the parts' own coordinates, X^T X = I
  std::vector<AssemblyPoint> points;
  std::vector<Lining> linings;
  bool convection = true;          ///< see AssemblyOptions
  std::vector<std::string> notes;  ///< notes for the user, one sentence each

  Eigen::Index n_coordinates() const { return disc.n_modes() + omega.size(); }
};

/// Joins the parts and finds the contact points.
/// @param bodies  modal bodies of the parts, in their order
/// @throws chladni::Error naming the key of the scene, for faces that do not touch the disc, nodes
///         that a part does not have, joints whose nodes do not meet, and parts that nothing holds.
Assembly assembly(const AssemblyOptions& options, std::span<const mbs_export::ModalBody> bodies);

/// A brake that differs little from another one, in the coordinates of that one, so that the
/// difference of the state matrices is a derivative. Masses are I up to the square of the
/// difference where rigid joints move.
/// @param about   of the same bodies, joints and linings
/// @param options  with other numbers for parts, joints, linings and contact planes
/// @throws chladni::Error as `assembly`, and when rigid joints hold more than they did.
Assembly neighbour(const Assembly& about, const AssemblyOptions& options,
                   std::span<const mbs_export::ModalBody> bodies);

/// State matrix A of x' = A x about the sliding equilibrium with x = (diag(s) z, z'). The scale s
/// is the frequency of each coordinate, but at least the lowest frequency of the disc.
/// @param linings  used in place of those of the assembly
/// @param speed    rad/s, > 0
/// @return [2 n x 2 n], 1/s
Eigen::MatrixXd state_matrix(const Assembly& assembly, std::span<const Lining> linings,
                             double speed);

}  // namespace chladni::squeal
