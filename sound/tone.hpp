#pragma once

#include <optional>

#include "sound/air_plan.hpp"
#include "sound/field.hpp"
#include "sound/surface_motion.hpp"

namespace chladni::sound {

/// A periodic motion of a body: displacement Re sum_h exp(i h omega t) sum_i harmonics(i, h - 1)
/// shape_i, in a frame that does not rotate.
struct Vibration {
  double speed;                ///< of the disc, rad/s
  double omega;                ///< rad/s
  std::vector<int> modes;      ///< [n_modes] 0-based in the body
  Eigen::MatrixXcd harmonics;  ///< [n_modes x n_harmonics] m kg^(1/2)
};

/// The sound of one harmonic of a vibration.
struct Tone {
  int h;              ///< multiple of the frequency
  double omega;       ///< of the tone, rad/s
  int n_unknowns;     ///< of all its systems of equations
  int n_elements;     ///< of its mesh
  double memory_MiB;  ///< of the largest factor
  /// Of each circumferential harmonic, with the columns cos(n phi) and sin(n phi); or one of space.
  std::vector<Field> fields;
};

/// A body whose sound is computed.
struct Source {
  const ThickBody& body;
  const SurfaceMotion& motion;  ///< of the modes of the vibration, in their order
  const AirOptions& air;
};

/// The tones up to `n_harmonics` whose surface moves at all: below 1e-9 of the velocity of the
/// first one there is rounding.
/// @throws chladni::Error from plan_air.
/// @note MPI must be running.
std::vector<Tone> tones(const Source& source, const Vibration& vibration, int n_harmonics);

/// Looks at the air of all these tones without solving for any.
/// @throws chladni::Error from plan_air.
void check_air(const Source& source, const Vibration& vibration, int n_harmonics);

/// What the elements of the air leave out of a tone, relative to it: an estimate from the same tone
/// with larger elements. What the absorbing layer reflects is not in it.
struct Accuracy {
  double balance;  ///< power far away over that at the surface, less 1
  /// In the mean square over all directions far away; absent when Gmsh has no mesh of larger ones.
  std::optional<double> pressure;

  /// Of the power at the surface, when e is that of the pressure: the power far away is the mean
  /// square of the pressure, hence 2 e + e^2, to which the balance is added.
  std::optional<double> power() const;
};

/// Solves for the tone of the vibration once more, with the elements of `coarsened`.
/// @note MPI must be running.
Accuracy accuracy(const Source& source, const Vibration& vibration, const Tone& tone);

/// Complex pressures at points of space, Pa.
/// @throws chladni::Error when a point is inside the body.
Eigen::VectorXcd pressure_at(const Tone& tone, const Eigen::MatrixX3d& x);

/// p R exp(ikR) far away, Pa m.
Eigen::VectorXcd far_field(const Tone& tone, const Eigen::MatrixX3d& directions);

/// Radiated power at the surface and far away, W.
double near_power(const Tone& tone);
double far_power(const Tone& tone);

}  // namespace chladni::sound
