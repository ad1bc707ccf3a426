#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// The periodic motion at the end of a transient.
struct LimitCycle {
  double speed;             ///< rad/s
  double frequency_Hz;      ///< in the inertial frame
  double pad_velocity;      ///< velocity amplitude of the first upper pad, m/s
  double pad_displacement;  ///< half the stroke of the first upper pad, m
  double N_min;             ///< smallest normal force on the first upper pad, N
  double N_max;             ///< largest normal force on the first upper pad, N
  double drift;             ///< relative change of the envelope over the last tenth of the run
  bool settled;             ///< whether |drift| is below settled_drift
  std::optional<double> t_zero_force;  ///< time when a normal force first reaches zero, s
  double t_99;  ///< time when the envelope first reaches 99 % of its final value, s
  std::vector<int> mode_numbers;  ///< [n_modes] 1-based numbers of the body's modes
  /// [n_modes] complex amplitudes of the fundamental harmonic: the displacement at the inertial
  /// angle phi and time t is Re(exp(i omega t) sum_i amplitude_i shape_i(phi)) with the mode shapes
  /// of the body. Empty when the disc is not axisymmetric.
  Eigen::VectorXcd amplitude;
};

/// Energy balance of a periodic motion over one period, J: friction + normal + damping = 0. Work is
/// the work on the vibration of disc and plates, that is, forces times velocities of the disc in
/// its own frame and of pads with a mass. The rest of the friction work comes from the drive.
struct CycleEnergy {
  Eigen::VectorXd friction;  ///< [n_pads] work of the friction of each pad pair
  Eigen::VectorXd normal;    ///< [n_pads] work of its normal forces
  double damping;            ///< work of modal damping and of the pads' suspensions, < 0
  Eigen::VectorXd heat;      ///< [n_pads] frictional heat, > 0; not part of the sum
  /// Mean kinetic and elastic energy of disc, plates and suspensions.
  double stored;
};

/// Whether small disturbances of a limit cycle decay.
enum class CycleStability {
  stable,    ///< they decay
  unstable,  ///< they grow
  undecided  ///< the largest multiplier is 1 within its error, as at a fold or a Hopf point
};

/// The stability in a word: "stable", "unstable" or "undecided".
const char* name_of(CycleStability stability);

/// Estimated errors of the numbers of a limit cycle; all parts are absent where they are unknown.
struct CycleErrors {
  ErrorBudget frequency_Hz = {};
  ErrorBudget pad_velocity = {};      ///< m/s
  ErrorBudget pad_displacement = {};  ///< m
};

/// A periodic motion found directly, x(T) = x(0) in the inertial frame.
struct DirectLimitCycle {
  double speed;             ///< rad/s
  double frequency_Hz;      ///< 1 / T
  double pad_velocity;      ///< largest velocity of the first upper pad, m/s
  double pad_displacement;  ///< half the stroke of the first upper pad, m
  double N_min;             ///< smallest normal force on the first upper pad, N
  double N_max;             ///< largest normal force on the first upper pad, N
  double slip_speed_min;    ///< smallest sliding speed of the first pad pair, m/s
  /// [2 n_modes] Floquet multipliers, the factors of disturbances over one period: first the one
  /// along the cycle, which is 1, then the others by descending modulus.
  Eigen::VectorXcd multipliers;
  /// Estimated error of the largest modulus of the others, by integration and shooting; absent in
  /// files of earlier versions.
  std::optional<double> multiplier_error = {};
  int n_newton_steps;                  ///< steps of the successful search
  std::int64_t n_contact_evaluations;  ///< number of all contact evaluations; see SlidingDisc
  Eigen::VectorXd x;                   ///< a state on the cycle; see SlidingDisc
  std::vector<int> mode_numbers;       ///< [n_modes] 1-based numbers of the body's modes
  Eigen::VectorXcd amplitude;          ///< [n_modes] fundamental harmonic; see LimitCycle
  CycleEnergy energy;
  /// Successful start of the search, in words; empty in files of earlier versions.
  std::string way = {};
  CycleErrors errors = {};
};

/// The quantities that a branch stores of each limit cycle; see DirectLimitCycle.
struct BranchPoint {
  double speed;  ///< rad/s
  double frequency_Hz;
  double pad_velocity;        ///< m/s
  double pad_displacement;    ///< m
  double N_min;               ///< N
  double N_max;               ///< N
  double largest_multiplier;  ///< largest modulus of the multipliers except the one along the cycle
  std::optional<double> multiplier_error = {};
};

/// Whether the largest multiplier is below or above 1, or neither within its error; 1e-6 in files
/// of earlier versions, to which they integrated. Undecided where only that along the cycle is
/// known.
CycleStability stability_of(const DirectLimitCycle& cycle);
CycleStability stability_of(const BranchPoint& point);

/// The Hopf point at which a branch of limit cycles leaves the sliding equilibrium.
struct BranchOrigin {
  double speed;         ///< speed at which stability is lost or regained, rad/s
  double frequency_Hz;  ///< frequency of the undamped oscillation at that speed
  BranchPoint first;    ///< the small cycle from which the branch was followed
};

/// Limit cycles over the speed, in order along their branch.
struct LimitCycleBranch {
  std::vector<BranchPoint> points;
  /// Folds, where the branch turns back: two cycles, usually one stable and one unstable, meet and
  /// vanish there.
  std::vector<BranchPoint> folds = {};
  /// Speed (rad/s) below which, or above which, the branch could not be followed.
  std::optional<double> lost_below = {};
  std::optional<double> lost_above = {};
  std::optional<BranchOrigin> origin = {};  ///< absent when the branch begins elsewhere
  /// Where and why the branch does not begin at its origin or is continued from another cycle.
  std::string note = {};
  /// Index of the first point that is not connected with those before it; absent when all are
  /// connected.
  std::optional<std::size_t> second_part = {};
};

}  // namespace chladni::squeal
