#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::squeal {

/// What each mode does at one point of the contact ring.
struct Shapes {
  Eigen::VectorXd W;    ///< [n_modes] displacement along the axis, m per unit of q
  Eigen::VectorXd W_r;  ///< [n_modes] radial slope, rad per unit of q
  Eigen::VectorXd W_t;  ///< [n_modes] circumferential slope, rad per unit of q
  /// [n_modes] displacements in the plane, m per unit of q; empty where no pad feels them
  Eigen::VectorXd V_r = {}, V_t = {};
};

/// [n_modes x 3 or 5] W, W_r, W_t, V_r, V_t side by side.
inline Eigen::MatrixXd matrix_of(const Shapes& shapes)
{
  const bool in_plane = shapes.V_r.size() > 0;
  Eigen::MatrixXd S(shapes.W.size(), in_plane ? 5 : 3);
  S.leftCols<3>() << shapes.W, shapes.W_r, shapes.W_t;
  if (in_plane) S.rightCols<2>() << shapes.V_r, shapes.V_t;
  return S;
}

/// A function of the ring angle for each mode, f_i(theta) = sum_k cosine_ki cos(k theta)
/// + sine_ki sin(k theta): the trigonometric interpolation of values at n equally spaced nodes.
struct Harmonics {
  Eigen::MatrixXd cosine;  ///< [n/2 + 1 x n_modes]
  Eigen::MatrixXd sine;    ///< [n/2 + 1 x n_modes]
};

/// A contact ring and the mode shapes along it.
struct DiscRing {
  std::string name;
  double radius;    ///< m
  Harmonics W;      ///< m per unit of q
  Harmonics W_r;    ///< rad per unit of q
  Harmonics W_t;    ///< rad per unit of q
  int n_nodes = 0;  ///< that the harmonics interpolate; 0 when they are no interpolation
  Harmonics V_r = {}, V_t = {};  ///< in the plane, m per unit of q; empty where no pad feels them
  double height = 0.0;           ///< z, m

  /// Harmonics of which both cosine and sine are known: through n / 2 of n nodes goes one function
  /// only, cos(n theta / 2), which no disc that turns can have alone.
  Eigen::Index n_whole_harmonics() const
  {
    return n_nodes > 0 && n_nodes % 2 == 0 ? W.cosine.rows() - 1 : W.cosine.rows();
  }
};

/// A function along a ring, and by what its value is multiplied to become a length: slopes by the
/// radius.
struct RingFunction {
  const Harmonics* values;
  double scale;
};

/// W, W_r, W_t of a ring, and V_r, V_t where pads feel them.
std::vector<RingFunction> functions_of(const DiscRing& ring);

/// Name, radius (m) and height (m) of a contact ring.
struct RingPlace {
  std::string name;
  double radius;
  double height = 0.0;
};

/// Trigonometric interpolation of the columns of `values` [n x n_modes], which are given at the
/// ascending, equally spaced `angles` [n] (rad).
/// @throws chladni::Error when the angles are not equally spaced over the circle.
Harmonics harmonics_of(const Eigen::VectorXd& angles, const Eigen::MatrixXd& values);

/// Which rings of a body the pads touch, and what is taken of them.
struct RingChoice {
  std::vector<std::string> names;
  bool in_plane = false;                      ///< with the displacements in the plane
  std::vector<std::string> slopes_from = {};  ///< as in SquealOptions
};

/// The ring of this name of a body. Its slopes are those of the rotations of its nodes; where these
/// are none, or where the choice names rings beside it, they are taken from displacements along the
/// axis: the circumferential one from those of the ring itself, the radial one from the polynomial
/// through it and the rings beside it that lie at its height. Without such rings the radial slope
/// of one of two rings at different heights is how the line between them leans.
/// @throws chladni::Error for an unknown ring, nodes that are not equally spaced, displacements
/// that
///         the body does not have, and slopes of which nothing tells.
DiscRing disc_ring(const mbs_export::ModalBody& body, const std::string& name,
                   const RingChoice& choice);

/// Shapes at the angle `theta` (rad) of a ring, exact for harmonics below half its nodes.
Shapes shapes_at(const DiscRing& ring, double theta);

}  // namespace chladni::squeal
