#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::squeal {

/// Amplitudes of an oscillation over the frequency.
struct Spectrum {
  Eigen::VectorXd frequency_Hz;
  Eigen::VectorXd
      amplitude;  ///< of the pad velocity, m/s; a sine of amplitude 1 m/s has a peak of 1

  struct Peak {
    double frequency_Hz;  ///< between the lines of the spectrum
    double amplitude;     ///< m/s
  };
  std::vector<Peak> peaks;  ///< by falling amplitude
};

/// What the first upper pad does over the last whole rotations of a transient. It describes any
/// lasting motion, also one that never repeats itself because the disc turns its asymmetry past the
/// pads.
struct MotionStatistics {
  /// A line of the spectrum of the pad velocity.
  struct Line {
    double frequency_Hz;
    double amplitude;  ///< m/s
    /// Its distance from the strongest line over the frequency of rotation. The turning disc makes
    /// lines at whole numbers.
    double rotations;
  };

  double speed;              ///< of rotation, rad/s
  double from;               ///< begin of the first of the rotations, s
  int n_rotations;           ///< even
  double band_Hz;            ///< up to which frequencies the effective values hold the motion
  double rms_velocity;       ///< effective pad velocity, m/s
  double peak_velocity;      ///< largest |pad velocity|, m/s
  double rms_displacement;   ///< effective pad displacement about its mean, m
  double peak_displacement;  ///< largest |pad displacement|, m
  double N_min;              ///< least normal force on the first pads, N
  double N_max;              ///< largest normal force on the first pads, N
  double open;               ///< part of the time in which one of the first pads is not pressed
  double drift;              ///< relative change of rms_velocity between the halves of the time
  bool settled;              ///< |drift| below settled_rms_drift
  /// Effective pad velocity while the disc passes each of equal parts of a rotation, mean over the
  /// rotations, m/s. The first part begins at the angle 0 of `speed` times the time.
  Eigen::VectorXd rms_over_angle;
  double modulation;        ///< (max - min) / (max + min) of `rms_over_angle`
  std::vector<Line> lines;  ///< by falling amplitude; those above a hundredth of the strongest
};

/// The pad velocity of a transient over time and frequency, with the rotation of the disc: what a
/// run-up or a braking shows. Windows overlap by three quarters.
struct Spectrogram {
  Eigen::VectorXd t;             ///< [n_t] middle of each window, s
  Eigen::VectorXd speed;         ///< [n_t] of rotation there, rad/s
  Eigen::VectorXd envelope;      ///< [n_t] largest pad velocity in the window, m/s
  Eigen::VectorXd frequency_Hz;  ///< [n_f]
  Eigen::MatrixXd amplitude;     ///< [n_t x n_f] m/s, the largest of the lines about a frequency
  /// [n_t x n_lines] the strongest lines of each window by falling amplitude; zero where there are
  /// fewer
  Eigen::MatrixXd line_Hz, line_amplitude;
};

}  // namespace chladni::squeal
