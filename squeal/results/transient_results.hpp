#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace chladni::squeal {

/// Largest motion of the first upper pad in consecutive windows of time.
struct Envelope {
  std::vector<double> t;                 ///< time of the largest velocity, s
  std::vector<double> pad_velocity;      ///< m/s
  std::vector<double> pad_displacement;  ///< m
};

/// Extremes of the first pad pair over all samples of consecutive windows of time.
struct Windows {
  std::vector<double> t;               ///< time of the first sample, s
  std::vector<double> speed;           ///< rotation speed at `t`, rad/s
  std::vector<double> N_up_min;        ///< normal force on the upper pad, N
  std::vector<double> N_up_max;        ///< N
  std::vector<double> N_lo_min;        ///< normal force on the lower pad, N
  std::vector<double> N_lo_max;        ///< N
  std::vector<double> slip_speed_min;  ///< smallest sliding speed of the upper pad, m/s
  /// Fraction of the samples at which one of the two pads has no contact.
  std::vector<double> open;
};

/// How a history samples the motion.
enum class Sampling {
  whole,         ///< every sample of the run
  band_limited,  ///< reduced rate after a low-pass filter
  decimated      ///< reduced rate without a filter; frequencies above half the rate are aliased
};

/// Frequency content of a history.
struct Band {
  Sampling sampling = Sampling::decimated;
  double rate_Hz = 0.0;  ///< sampling rate
  double to_Hz = 0.0;    ///< frequency up to which the samples represent the motion
};

/// Sampled motion and forces of the first pad pair.
struct History {
  std::vector<double> t;                 ///< s
  std::vector<double> pad_velocity;      ///< velocity of the upper pad, m/s
  std::vector<double> pad_displacement;  ///< displacement of the upper pad, PadState::z - h / 2, m
  std::vector<double> N_up;              ///< normal force on the upper pad, N
  std::vector<double> N_lo;              ///< normal force on the lower pad, N
  /// Sliding speed of the upper pad on the disc, m/s; the smallest of a grid's points.
  std::vector<double> slip_speed = {};
};

/// A loss or gain of contact at a point of a pad.
struct ContactEvent {
  double t;    ///< s
  int pad;     ///< upper and lower pad of each pair in turn, from 0
  bool gains;  ///< false: contact is lost
};

/// A transient, computed in the rotating frame or by a model without a body.
struct Transient {
  double speed;                   ///< rad/s
  double step;                    ///< sampling step, s; also the integration step if that is fixed
  bool finished;                  ///< false: the motion diverged and the run ended early
  std::string integrator;         ///< name as in the scene
  std::string integrator_reason;  ///< reason of an automatic choice
  std::int64_t n_steps;           ///< steps of the integration
  /// Evaluations of all pad forces, including those for samples.
  std::int64_t n_contact_evaluations;
  std::int64_t n_events = 0;         ///< located by "dormand-prince" only; 0 for other methods
  std::vector<ContactEvent> events;  ///< the first events
  Envelope envelope;
  Windows windows;  ///< whole run; empty in files of earlier versions
  Band band;        ///< frequency content of `history`
  History history;  ///< whole run
  History tail;     ///< end of the run with every sample
  /// 1-based numbers of the body's modes in `tail_a`; empty without a body and when read from a
  /// file.
  std::vector<int> mode_numbers = {};
  /// [n_modes x n_tail] modal coordinates in the inertial frame; see LimitCycle.
  Eigen::MatrixXd tail_a;
  double N_min;                        ///< over all pads, N
  double N_max;                        ///< over all pads, N
  double slip_speed_min;               ///< over all pads, m/s
  std::optional<double> t_zero_force;  ///< time when a normal force first reaches zero, s
  std::optional<double> growth_rate;   ///< growth rate of the linear phase, 1/s, if there is one
  std::string warning = {};            ///< a reason to doubt the results; else empty
};

/// Growth of a small disturbance at one speed, from a transient and from the eigenvalues.
struct Growth {
  double speed;  ///< rad/s
  Envelope envelope;
  double rate;                            ///< slope of ln(envelope) by least squares, 1/s
  std::optional<double> eigenvalue_rate;  ///< largest Re lambda, 1/s; absent if not axisymmetric
};

/// The frequency content of a history as text: "band-limited to 11400 Hz, 30000 samples in a
/// second".
std::string spoken(const Band& band);

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
