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

/// The lining of a whole face.
struct Lining {
  double area;       ///< m^2, 0 where the nodes enclose none
  double stiffness;  ///< N/m
  double damping;    ///< N s/m
  double preload;    ///< N
  FrictionLaw friction;
  bool has_own_friction;  ///< else that of the brake
};

/// A point of contact between the disc and a part.
struct AssemblyPoint {
  std::size_t contact;  ///< which of the linings
  double sigma;         ///< 1 above the disc, -1 below it
  PadFace place;
  double share, area;  ///< of the lining
  /// [n x rows] what each coordinate does there: (w, g_r, g_t) or (w, g_r, g_t, v_r, v_t) of the
  /// disc, then (r, t, z) of the face.
  Eigen::MatrixXd S;
};

/// A disc between parts on their joints, in the inertial frame, without contact. The coordinates
/// are those of the disc, then the modes of the joined parts, b'' + C b' + diag(omega^2) b = f, all
/// counted from the sliding equilibrium with the preload of each lining shared as its area is.
struct Assembly {
  InertialDisc disc;
  Eigen::VectorXd omega;  ///< [n_b] rad/s; 0 of motions that linings alone hold
  Eigen::MatrixXd K;      ///< [n_b x n_b] 1/s^2, diag(omega^2), but see `neighbour`
  Eigen::MatrixXd C;      ///< [n_b x n_b] 1/s
  Eigen::MatrixXd X;      ///< [n x n_b] motions of the parts' own coordinates, X^T X = I
  std::vector<AssemblyPoint> points;
  std::vector<Lining> linings;
  bool convection = true;          ///< see AssemblyOptions
  std::vector<std::string> notes;  ///< what a user should know of it, a sentence each

  Eigen::Index n_coordinates() const { return disc.n_modes() + omega.size(); }
};

/// @param bodies  of the parts, in their order
/// @throws chladni::Error naming the key of the scene, for faces that do not touch the disc, nodes
///         that a part does not have, joints that do not meet, and parts that nothing holds.
Assembly assembly(const AssemblyOptions& options, std::span<const mbs_export::ModalBody> bodies);

/// A brake that differs little from another one, in the coordinates of that one, so that the
/// difference of the state matrices is a derivative. Masses are I up to the square of the
/// difference where rigid joints move.
/// @param about   of the same bodies, joints and linings
/// @param options  with other numbers for parts, joints, linings and contact planes
/// @throws chladni::Error as `assembly`, and when rigid joints hold more than they did.
Assembly neighbour(const Assembly& about, const AssemblyOptions& options,
                   std::span<const mbs_export::ModalBody> bodies);

/// A of x' = A x about the sliding equilibrium, as `state_matrix` of a disc between pads:
/// x = (diag(s) z, z'), s the frequencies of disc and parts, or the lowest of the disc where it is
/// higher.
/// @param linings  in place of those of the assembly
/// @param speed    rad/s, > 0
/// @return [2 n x 2 n], 1/s
Eigen::MatrixXd state_matrix(const Assembly& assembly, std::span<const Lining> linings,
                             double speed);

}  // namespace chladni::squeal
