#pragma once

namespace chladni::sound {

/// Properties of the air.
struct Medium {
  double density = 1.2;           ///< kg/m^3
  double speed_of_sound = 343.0;  ///< m/s
};

/// The wave Re(p exp(i omega t)), in the meridian plane with p ~ cos(n phi); n is not used in
/// space.
struct Wave {
  Medium medium;
  double omega;  ///< rad/s
  int n = 0;     ///< circumferential harmonic

  double k() const { return omega / medium.speed_of_sound; }  ///< wave number, 1/m
};

/// Perfectly matched layer: in the shell R > R_p of thickness d the coordinates become complex, x
/// [1 - i alpha xi^(m + 1) / (k R)] with xi = (R - R_p) / d, so that an outgoing wave decays by
/// exp(-alpha) to the outer end.
struct AbsorbingLayer {
  double alpha = 10.0;
  int m = 1;
};

}  // namespace chladni::sound
