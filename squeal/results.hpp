#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "squeal/cycle_results.hpp"

namespace chladni::squeal {

/// Eigenvalues with Im >= 0 of the sliding disc, each column followed over the speed.
struct EigenvalueMap {
  Eigen::VectorXd speeds;   ///< [m] rad/s
  Eigen::MatrixXcd lambda;  ///< [m x n_modes] growth rate 1/s + i angular frequency rad/s
  /// For each speed [n_modes x n_modes]: column j is the complex shape of the eigenvalue j,
  /// displacements of the modes of the body as in `LimitCycle::amplitude`, then of those of pads
  /// with a mass, of norm 1.
  /// Empty for models without a body.
  std::vector<Eigen::MatrixXcd> shapes = {};
};

/// The speed at which the sliding disc loses its stability.
struct CriticalSpeed {
  double speed;         ///< rad/s
  double frequency_Hz;  ///< of the undamped oscillation there
};

/// Where the sliding disc loses or regains its stability over one parameter.
struct CriticalValue {
  std::string parameter;        ///< "friction", "preload" or "stiffness"
  double speed;                 ///< rad/s
  std::optional<double> value;  ///< 1, N or N/m; absent when there is none in the range
  double frequency_Hz;          ///< of the undamped oscillation there
  int n_newton_steps;
};

/// The least stable eigenvalue of the sliding disc over the speed and one more parameter.
struct StabilityMap {
  std::string parameter;         ///< "friction", "preload" or "stiffness"
  Eigen::VectorXd values;        ///< [m] of it: 1, N or N/m
  Eigen::VectorXd speeds;        ///< [n] rad/s
  Eigen::MatrixXd growth;        ///< [m x n] largest growth rate, 1/s
  Eigen::MatrixXd frequency_Hz;  ///< [m x n] of the oscillation with it
};

/// Largest motion of the first upper pad within successive windows of time.
struct Envelope {
  std::vector<double> t;                 ///< s, when the velocity was largest
  std::vector<double> pad_velocity;      ///< m/s
  std::vector<double> pad_displacement;  ///< m
};

/// Samples of the first pad pair.
struct History {
  std::vector<double> t;                 ///< s
  std::vector<double> pad_velocity;      ///< of the upper pad, m/s
  std::vector<double> pad_displacement;  ///< of the upper pad from its position at rest, m
  std::vector<double> N_up;              ///< normal force on the upper pad, N
  std::vector<double> N_lo;              ///< normal force on the lower pad, N
};

/// The modes at the times of a history, in the frame that rotates with the disc.
struct ModalHistory {
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
  std::vector<ContactEvent> events;    ///< located by "dormand-prince" alone; empty with the others
  Envelope envelope;
  History history;           ///< the whole run, decimated
  ModalHistory modes;        ///< at the times of `history`
  History tail;              ///< the end of the run, every step
  std::vector<float> sound;  ///< pad velocity at the rate asked for, m/s; empty when not asked for
  Eigen::MatrixXd tail_a;    ///< [n_modes x n_tail] q in the inertial frame; see LimitCycle
  double N_min;              ///< over all pads, N
  double N_max;              ///< over all pads, N
  double slip_speed_min;     ///< over all pads, m/s
  std::optional<double> t_zero_force;  ///< when a normal force first reaches zero, s
  std::optional<double> growth_rate;   ///< of the linear phase, 1/s, when there is one
};

/// Growth of a small disturbance at one speed, from a simulation and from the eigenvalues.
struct Growth {
  double speed;  ///< rad/s
  Envelope envelope;
  double rate;                            ///< least squares of ln(envelope), 1/s
  std::optional<double> eigenvalue_rate;  ///< largest Re lambda, 1/s; absent if not axisymmetric
};

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

/// What the lowest modes alone would say.
struct ModeSubset {
  int n_modes;
  double highest_Hz;
  std::optional<double> critical_speed;         ///< rad/s; absent when there is none in the range
  std::optional<double> critical_frequency_Hz;  ///< of the oscillation there
  double growth;  ///< largest growth rate at the critical speed of all modes, 1/s
};

/// What one mode, or one pair of modes, does to the critical oscillation of all modes.
struct ModeInfluence {
  int nodal_diameters;
  double frequency_Hz;   ///< of the mode
  double participation;  ///< part of the kinetic energy of the critical oscillation
  /// Growth rate of the critical oscillation at the critical speed when the mode is left out, 1/s;
  /// absent for the mode that it consists of.
  std::optional<double> growth_without;
  std::optional<double> critical_speed_without;  ///< rad/s
};

/// Which modes move the critical speed.
struct ModeSensitivity {
  double critical_speed;  ///< with all modes, rad/s
  double critical_frequency_Hz;
  std::vector<ModeSubset> subsets;        ///< of the lowest 2, 8, 16 and of all modes
  std::vector<ModeInfluence> influences;  ///< by rising frequency
};

/// Everything that a study may yield; what was not asked for is absent.
struct SquealResults {
  /// Largest relative difference of the two frequencies of a pair of modes, which eigenvalues are
  /// computed without; absent when the disc is not axisymmetric. 1e-4 of split changes the growth
  /// rate of the reference disc by 1e-4 of it, 1e-3 by 1e-2.
  std::optional<double> largest_split;
  std::optional<EigenvalueMap> eigenvalues;
  bool searched_critical_speed = false;  ///< tells "none in the range" from "not asked for"
  std::optional<CriticalSpeed> critical_speed;
  std::vector<CriticalValue> critical_values;
  std::optional<StabilityMap> map;
  std::optional<ModeSensitivity> mode_sensitivity;
  std::vector<Growth> growth;
  std::optional<Transient> transient;
  std::optional<LimitCycle> limit_cycle;
  std::optional<DirectLimitCycle> limit_cycle_direct;
  std::optional<LimitCycleBranch> limit_cycle_branch;
  std::optional<Spectrum> spectrum;
  /// Why an analysis failed after others had succeeded; nothing was done after it.
  std::optional<std::string> failure;
};

}  // namespace chladni::squeal
