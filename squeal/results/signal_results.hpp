#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::squeal {

/// Amplitude spectrum of an oscillation.
struct Spectrum {
  Eigen::VectorXd frequency_Hz;
  /// Amplitude of the pad velocity, m/s; a sine of amplitude 1 m/s has a peak of 1.
  Eigen::VectorXd amplitude;

  /// A peak of the spectrum.
  struct Peak {
    double frequency_Hz;  ///< interpolated between the lines of the spectrum
    double amplitude;     ///< m/s
  };
  std::vector<Peak> peaks;  ///< by descending amplitude
};

/// Statistics of the first upper pad's motion over the last whole rotations of a transient. They
/// apply to any lasting motion, also to one that is not periodic because the disc's asymmetry
/// rotates past the pads.
struct MotionStatistics {
  /// A line of the spectrum of the pad velocity.
  struct Line {
    double frequency_Hz;
    double amplitude;  ///< m/s
    /// Distance from the strongest line divided by the rotation frequency. The rotation of the disc
    /// causes lines at integers.
    double rotations;
  };

  double speed;              ///< rotation speed, rad/s
  double from;               ///< begin of the first of these rotations, s
  int n_rotations;           ///< number of rotations, even
  double band_Hz;            ///< upper frequency limit of the effective values
  double rms_velocity;       ///< root mean square of the pad velocity, m/s
  double peak_velocity;      ///< largest |pad velocity|, m/s
  double rms_displacement;   ///< root mean square of the pad displacement about its mean, m
  double peak_displacement;  ///< largest |pad displacement|, m
  double N_min;              ///< smallest normal force on the first pads, N
  double N_max;              ///< largest normal force on the first pads, N
  double open;               ///< fraction of the time in which one of the first pads has no contact
  double drift;              ///< relative change of rms_velocity from the first to the second half
  bool settled;              ///< whether |drift| is below settled_rms_drift
  /// Root mean square of the pad velocity in equal sectors of a rotation, averaged over the
  /// rotations, m/s. The first sector begins at the angle 0, where the angle is `speed` times the
  /// time.
  Eigen::VectorXd rms_over_angle;
  double modulation;  ///< (max - min) / (max + min) of `rms_over_angle`
  /// Lines above a hundredth of the strongest, by descending amplitude.
  std::vector<Line> lines;
};

/// Pad velocity of a transient over time and frequency, with the rotation speed, for run-up and
/// braking. Windows overlap by three quarters.
struct Spectrogram {
  Eigen::VectorXd t;             ///< [n_t] middle of each window, s
  Eigen::VectorXd speed;         ///< [n_t] rotation speed, rad/s
  Eigen::VectorXd envelope;      ///< [n_t] largest pad velocity in the window, m/s
  Eigen::VectorXd frequency_Hz;  ///< [n_f]
  /// [n_t x n_f] largest amplitude of the spectral lines near each frequency, m/s.
  Eigen::MatrixXd amplitude;
  /// [n_t x n_lines] strongest lines of each window by descending amplitude, Hz and m/s; zero when
  /// there are fewer.
  Eigen::MatrixXd line_Hz, line_amplitude;
};

}  // namespace chladni::squeal
