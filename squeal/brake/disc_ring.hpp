#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::squeal {

/// Mode shapes at one point of a contact ring.
struct Shapes {
  Eigen::VectorXd W;    ///< [n_modes] axial displacement, m per unit of q
  Eigen::VectorXd W_r;  ///< [n_modes] radial slope, rad per unit of q
  Eigen::VectorXd W_t;  ///< [n_modes] circumferential slope, rad per unit of q
  /// [n_modes] in-plane displacements, m per unit of q; empty when they do not act on the pads.
  Eigen::VectorXd V_r = {}, V_t = {};
};

/// The shapes as columns W, W_r, W_t and, if present, V_r, V_t.
/// @return [n_modes x 3 or 5]
inline Eigen::MatrixXd matrix_of(const Shapes& shapes)
{
  const bool in_plane = shapes.V_r.size() > 0;
  Eigen::MatrixXd S(shapes.W.size(), in_plane ? 5 : 3);
  S.leftCols<3>() << shapes.W, shapes.W_r, shapes.W_t;
  if (in_plane) S.rightCols<2>() << shapes.V_r, shapes.V_t;
  return S;
}

/// A function of the ring angle for each mode as a Fourier series, f_i(theta) = sum_k cosine_ki
/// cos(k theta) + sine_ki sin(k theta): the trigonometric interpolation of values at n equally
/// spaced nodes.
struct Harmonics {
  Eigen::MatrixXd cosine;  ///< [n/2 + 1 x n_modes]
  Eigen::MatrixXd sine;    ///< [n/2 + 1 x n_modes]
};

/// A contact ring and the mode shapes along it.
struct DiscRing {
  std::string name;
  double radius;  ///< m
  Harmonics W;    ///< m per unit of q
  Harmonics W_r;  ///< rad per unit of q
  Harmonics W_t;  ///< rad per unit of q
  /// Number of interpolated nodes; 0 when the series is not an interpolation.
  int n_nodes = 0;
  /// In-plane displacements, m per unit of q; empty when they do not act on the pads.
  Harmonics V_r = {}, V_t = {};
  double height = 0.0;  ///< z, m

  /// Number of harmonics with known cosine and sine. With an even number n of nodes the harmonic
  /// n / 2 has only the function cos(n theta / 2), which is not enough for a rotating disc.
  Eigen::Index n_whole_harmonics() const
  {
    return n_nodes > 0 && n_nodes % 2 == 0 ? W.cosine.rows() - 1 : W.cosine.rows();
  }
};

/// A function along a ring, with the factor that makes its values lengths: the radius for slopes.
struct RingFunction {
  const Harmonics* values;
  double scale;
};

/// The functions W, W_r, W_t of a ring and, if present, V_r, V_t.
std::vector<RingFunction> functions_of(const DiscRing& ring);

/// Name, radius (m) and height (m) of a contact ring.
struct RingPlace {
  std::string name;
  double radius;
  double height = 0.0;
};

/// Trigonometric interpolation of values on a ring.
/// @param angles  [n] ascending, equally spaced, rad
/// @param values  [n x n_modes]
/// @throws chladni::Error when the angles are not equally spaced over the circle.
Harmonics harmonics_of(const Eigen::VectorXd& angles, const Eigen::MatrixXd& values);

/// The contact rings of a body, and the displacements to read on them.
struct RingChoice {
  std::vector<std::string> names;
  bool in_plane = false;                      ///< with in-plane displacements
  std::vector<std::string> slopes_from = {};  ///< see SquealOptions
};

/// The ring of a body with this name. Its slopes are the rotations of its nodes. If there are none,
/// or if the choice names neighbouring rings, slopes are computed from axial displacements: the
/// circumferential slope from those of the ring itself, the radial slope from the polynomial
/// through the ring and its neighbours at the same height. Without neighbours, the radial slope of
/// one of two rings at different heights is the tilt of the line between them.
/// @throws chladni::Error for an unknown ring, nodes that are not equally spaced, displacements
///         that the body does not have, and slopes that cannot be computed.
DiscRing disc_ring(const mbs_export::ModalBody& body, const std::string& name,
                   const RingChoice& choice);

/// Mean of cos(d theta) over a round patch about theta = 0, by even pressure.
/// @param patch  its radius over that of the ring
/// @return 2 J_1(d patch) / (d patch)
double mean_over_patch(int d, double patch);

/// Mode shapes at the angle `theta` (rad) of a ring; exact for harmonics below half the number of
/// nodes.
Shapes shapes_at(const DiscRing& ring, double theta);

/// Fast evaluation of `shapes_at` at many angles: without allocation and without zero harmonics.
class RingShapes {
 public:
  explicit RingShapes(const DiscRing& ring);

  /// Mode shapes at the angle `theta` (rad), columns W, W_r, W_t and, if present, V_r, V_t; valid
  /// until the next call.
  /// @return [n_modes x 3 or 5]
  const Eigen::MatrixXd& at(double theta);

 private:
  std::vector<int> orders_;       ///< harmonics that are not zero
  Eigen::MatrixXd coefficients_;  ///< [n_columns n_modes x 2 n_orders] cosine and sine alternate
  Eigen::VectorXd waves_;         ///< [2 n_orders] cos(k theta), sin(k theta)
  Eigen::MatrixXd shapes_;
};

}  // namespace chladni::squeal
