#pragma once

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

/// Complex pressures at points of space, Pa.
/// @throws chladni::Error when a point is inside the body.
Eigen::VectorXcd pressure_at(const Tone& tone, const Eigen::MatrixX3d& x);

/// p R exp(ikR) far away, Pa m.
Eigen::VectorXcd far_field(const Tone& tone, const Eigen::MatrixX3d& directions);

/// Radiated power at the surface and far away, W.
double near_power(const Tone& tone);
double far_power(const Tone& tone);

}  // namespace chladni::sound
