#pragma once

#include <span>
#include <vector>

#include "sound/sound_options.hpp"
#include "sound/tone.hpp"

namespace chladni::sound {

/// Sound pressure levels are relative to 20 micropascal.
inline constexpr double reference_pressure = 20e-6;  // Pa

/// 20 log10 of the effective value of a pressure over the reference, dB.
double level_dB(double effective_pressure);

/// What the human ear makes of a frequency (IEC 61672-1), dB; 0 at 1 kHz.
double A_weighting_dB(double frequency_Hz);

/// What a microphone hears of all tones.
struct Heard {
  Eigen::VectorXcd pressure;  ///< [n_tones] Pa
  double peak;                ///< largest pressure amplitude of a tone, Pa
  double rms_dB;              ///< level of the effective value of all tones together
  double peak_dB;  ///< level of the amplitude instead of the effective value, as some sources print
  double A_dB;     ///< rms_dB with each tone weighted for the ear
  double least,
      largest;  ///< effective pressure on the circle of the microphone around the axis, Pa
};

std::vector<Heard> listen(const std::vector<Tone>& tones,
                          const std::vector<Microphone>& microphones);

/// Effective pressure times distance, far away.
struct Directivity {
  Eigen::VectorXd polar;    ///< [m] angle from the z axis, rad, 0 to pi
  Eigen::VectorXd azimuth;  ///< [n] rad
  Eigen::MatrixXd rms;      ///< [m x n] Pa m
};

Directivity directivity(const std::vector<Tone>& tones);

/// Loudness of the motion over the time, relative to its end: (t, amplitude) from a transient.
struct Onset {
  std::vector<double> t;          ///< s, ascending
  std::vector<double> amplitude;  ///< of the velocity, 1 at the end
};

/// Samples of the pressure at a microphone: Re sum_h p_h a^h exp(i h omega t), where a is the
/// onset, or 1 with 20 ms of fading at both ends.
std::vector<float> samples(const std::vector<Tone>& tones, const Eigen::VectorXcd& pressure,
                           const WavCase& wav, const Onset& onset);

}  // namespace chladni::sound
