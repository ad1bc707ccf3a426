#pragma once

#include <span>
#include <vector>

#include "sound/sound_options.hpp"
#include "sound/tone.hpp"

namespace chladni::sound {

/// Sound levels and directivity. Sound pressure levels refer to 20 micropascal.
inline constexpr double reference_pressure = 20e-6;  // Pa

/// Sound pressure level 20 log10(effective pressure / reference), dB.
/// @param effective_pressure  root mean square, Pa
double level_dB(double effective_pressure);

/// A-weighting of a frequency by IEC 61672-1, dB; 0 at 1 kHz.
double A_weighting_dB(double frequency_Hz);

/// Sound of all tones at a microphone.
struct Heard {
  Eigen::VectorXcd pressure;  ///< [n_tones] complex amplitudes, Pa
  double peak;                ///< largest amplitude of a single tone, Pa
  double rms_dB;              ///< level of the effective value of all tones, dB
  /// Level with the amplitude sqrt(2) rms in place of rms, as some sources state it.
  double peak_dB;
  double A_dB;  ///< A-weighted level of all tones
  /// Smallest and largest effective pressure on the circle through the microphone around the axis,
  /// Pa.
  double least, largest;
};

/// The sound of the tones at each microphone.
std::vector<Heard> listen(const std::vector<Tone>& tones,
                          const std::vector<Microphone>& microphones);

/// Effective far-field pressure times distance over the directions.
struct Directivity {
  Eigen::VectorXd polar;    ///< [m] angle from the z axis, rad, 0 to pi
  Eigen::VectorXd azimuth;  ///< [n] rad
  Eigen::MatrixXd rms;      ///< [m x n] rms of p R, Pa m
};

/// The directivity of all tones together.
Directivity directivity(const std::vector<Tone>& tones);

/// Relative amplitude of the motion over the time of a transient.
struct Onset {
  std::vector<double> t;          ///< s, ascending
  std::vector<double> amplitude;  ///< amplitude of the velocity, 1 at the end
};

/// Pressure at a microphone as samples for a sound file: Re sum_h p_h a^h exp(i h omega t) with the
/// relative amplitude a of the onset; without an onset a = 1 with 20 ms of fading at both ends.
/// Tones above half the sampling rate are left out.
/// @param pressure  [n_tones] complex amplitudes at the microphone, Pa
std::vector<float> samples(const std::vector<Tone>& tones, const Eigen::VectorXcd& pressure,
                           const WavCase& wav, const Onset& onset);

}  // namespace chladni::sound
