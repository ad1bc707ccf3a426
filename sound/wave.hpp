#pragma once

namespace chladni::sound {

/// What the sound travels in.
struct Medium {
  double density = 1.2;           ///< kg/m^3
  double speed_of_sound = 343.0;  ///< m/s
};

/// Re(p exp(i omega t)) with p ~ cos(n phi) in the meridian plane; n means nothing in space.
struct Wave {
  Medium medium;
  double omega;  ///< rad/s
  int n = 0;     ///< circumferential harmonic

  double k() const { return omega / medium.speed_of_sound; }  ///< wave number, 1/m
};

/// Perfectly matched layer: in the shell R > R_p of thickness d the coordinates become complex,
/// x [1 - i alpha xi^(m + 1) / (k R)] with xi = (R - R_p) / d, so that an outgoing wave falls by
/// exp(-alpha) to the outer end.
struct AbsorbingLayer {
  double alpha = 10.0;
  int m = 1;
};

}  // namespace chladni::sound
