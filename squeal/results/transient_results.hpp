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

/// Complete states at single times, in the frame that rotates with the disc. They do not form a
/// signal, because their distance may exceed the periods of the modes.
struct Snapshots {
  std::vector<double> t;       ///< s
  Eigen::MatrixXd q;           ///< [n_modes x n_t] m kg^(1/2)
  Eigen::MatrixXd v;           ///< [n_modes x n_t] m kg^(1/2) / s
  std::vector<double> energy;  ///< kinetic and elastic energy of the disc in this frame, J
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
  Windows windows;      ///< whole run; empty in files of earlier versions
  Band band;            ///< frequency content of `history`
  History history;      ///< whole run
  Snapshots snapshots;  ///< whole run; empty for models without a body
  History tail;         ///< end of the run with every sample
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

}  // namespace chladni::squeal
