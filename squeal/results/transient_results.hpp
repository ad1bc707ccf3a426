#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace chladni::squeal {

/// Largest motion of the first upper pad within successive windows of time.
struct Envelope {
  std::vector<double> t;                 ///< s, when the velocity was largest
  std::vector<double> pad_velocity;      ///< m/s
  std::vector<double> pad_displacement;  ///< m
};

/// The first pad pair within successive windows of time, of every sample in them.
struct Windows {
  std::vector<double> t;               ///< of the first sample, s
  std::vector<double> speed;           ///< of rotation, at `t`, rad/s
  std::vector<double> N_up_min;        ///< normal force on the upper pad, N
  std::vector<double> N_up_max;        ///< N
  std::vector<double> N_lo_min;        ///< normal force on the lower pad, N
  std::vector<double> N_lo_max;        ///< N
  std::vector<double> slip_speed_min;  ///< of the upper pad on the disc, m/s
  std::vector<double> open;  ///< part of the samples at which one of the two is not pressed
};

/// What samples are of the motion between them.
enum class Sampling {
  whole,         ///< every sample of the run
  band_limited,  ///< every so many, after what these could not hold was taken out
  decimated  ///< every so many as they were: frequencies above half the rate look like lower ones
};

/// Which frequencies a history holds.
struct Band {
  Sampling sampling = Sampling::decimated;
  double rate_Hz = 0.0;  ///< samples in a second
  double to_Hz = 0.0;    ///< up to which the samples are the motion
};

/// Samples of the first pad pair.
struct History {
  std::vector<double> t;                 ///< s
  std::vector<double> pad_velocity;      ///< of the upper pad, m/s
  std::vector<double> pad_displacement;  ///< of the upper pad, as PadState::z - h / 2, m
  std::vector<double> N_up;              ///< normal force on the upper pad, N
  std::vector<double> N_lo;              ///< normal force on the lower pad, N
  std::vector<double> slip_speed = {};   ///< of the upper pad on the disc, m/s; least of a grid
};

/// States at some times, each of them whole: a signal they are not, since they may be further apart
/// than the periods of the modes. In the frame that rotates with the disc.
struct Snapshots {
  std::vector<double> t;       ///< s
  Eigen::MatrixXd q;           ///< [n_modes x n_t] m kg^(1/2)
  Eigen::MatrixXd v;           ///< [n_modes x n_t] m kg^(1/2) / s
  std::vector<double> energy;  ///< kinetic and elastic energy of the disc in this frame, J
};

/// A contact point of a pad loses or regains its disc.
struct ContactEvent {
  double t;    ///< s
  int pad;     ///< upper and lower pad of each pair in turn, from 0
  bool gains;  ///< false: its axial force falls through zero
};

/// A transient in the rotating frame.
struct Transient {
  double speed;            ///< rad/s
  double step;             ///< of the samples, s; the one of the integration when that is fixed
  bool finished;           ///< false: the motion diverged and the run ended early
  std::string integrator;  ///< as in the scene
  std::string integrator_reason;       ///< why, when it was chosen by the program
  std::int64_t n_steps;                ///< of the integration
  std::int64_t n_contact_evaluations;  ///< of the forces of all pads, samples included
  std::int64_t n_events = 0;           ///< located by "dormand-prince" alone; 0 with the others
  std::vector<ContactEvent> events;    ///< the first of them
  Envelope envelope;
  Windows windows;      ///< the whole run; none in files of earlier versions
  Band band;            ///< of `history`
  History history;      ///< the whole run
  Snapshots snapshots;  ///< over the whole run; none of models without a body
  History tail;         ///< the end of the run, every sample
  /// Of the rows of `tail_a`, 1-based in the body; empty without a body and in results of a file.
  std::vector<int> mode_numbers = {};
  Eigen::MatrixXd tail_a;  ///< [n_modes x n_tail] q in the inertial frame; see LimitCycle
  double N_min;            ///< over all pads, N
  double N_max;            ///< over all pads, N
  double slip_speed_min;   ///< over all pads, m/s
  std::optional<double> t_zero_force;  ///< when a normal force first reaches zero, s
  std::optional<double> growth_rate;   ///< of the linear phase, 1/s, when there is one
  std::string warning = {};            ///< what to doubt, in words; empty when there is nothing
};

/// Growth of a small disturbance at one speed, from a simulation and from the eigenvalues.
struct Growth {
  double speed;  ///< rad/s
  Envelope envelope;
  double rate;                            ///< least squares of ln(envelope), 1/s
  std::optional<double> eigenvalue_rate;  ///< largest Re lambda, 1/s; absent if not axisymmetric
};

}  // namespace chladni::squeal
