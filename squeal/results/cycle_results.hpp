#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace chladni::squeal {

/// The periodic motion at the end of a transient.
struct LimitCycle {
  double speed;             ///< rad/s
  double frequency_Hz;      ///< in the inertial frame
  double pad_velocity;      ///< amplitude of the first upper pad, m/s
  double pad_displacement;  ///< half the travel of the first upper pad, m
  double N_min;             ///< smallest normal force on the first upper pad, N
  double N_max;             ///< largest normal force on the first upper pad, N
  double drift;             ///< relative change of the envelope over the last tenth of the run
  bool settled;             ///< drift below settled_drift
  std::optional<double> t_zero_force;  ///< when a normal force first reached zero, s
  double t_99;                         ///< when the envelope first reached 99 % of its end, s
  std::vector<int> mode_numbers;       ///< [n_modes] 1-based in the body
  /// [n_modes] complex amplitude of the fundamental: displacement at the inertial angle phi and
  /// time t is Re(exp(i omega t) sum_i amplitude_i shape_i(phi)), with the shapes of the body's
  /// modes. Empty when the disc is not axisymmetric.
  Eigen::VectorXcd amplitude;
};

/// What a periodic motion gains and loses in one period, J: the sum of all is zero. Works are those
/// on the vibration of disc and plates, i.e. forces times the velocities of the disc in its own
/// frame and of pads with a mass; the drive does the rest of the work of friction.
struct CycleEnergy {
  Eigen::VectorXd friction;  ///< [n_pads] of the friction of each pad pair
  Eigen::VectorXd normal;    ///< [n_pads] of its normal forces
  double damping;            ///< of the modes and of the suspensions of the pads, < 0
  Eigen::VectorXd heat;      ///< [n_pads] what friction turns into heat, > 0; not part of the sum
  double stored;             ///< kinetic and elastic energy of disc, plates and suspensions, mean
};

/// A periodic motion found as such: x(T) = x(0) in the inertial frame.
struct DirectLimitCycle {
  double speed;             ///< rad/s
  double frequency_Hz;      ///< 1 / T
  double pad_velocity;      ///< largest of the first upper pad, m/s
  double pad_displacement;  ///< half the travel of the first upper pad, m
  double N_min;             ///< smallest normal force on the first upper pad, N
  double N_max;             ///< largest normal force on the first upper pad, N
  double slip_speed_min;    ///< of the first pad pair, m/s
  /// [2 n_modes] Floquet multipliers, factors of a disturbance over one period: first the one along
  /// the cycle, which is 1, then the others by falling modulus.
  Eigen::VectorXcd multipliers;
  bool stable;                         ///< all but the first are below 1
  int n_newton_steps;                  ///< of the successful search
  std::int64_t n_contact_evaluations;  ///< in all; see SlidingDisc
  Eigen::VectorXd x;                   ///< a point of the cycle; see SlidingDisc
  std::vector<int> mode_numbers;       ///< [n_modes] 1-based in the body
  Eigen::VectorXcd amplitude;          ///< [n_modes] of the fundamental; see LimitCycle
  CycleEnergy energy;
  std::string way = {};  ///< which start led to it, in words; empty in files of earlier versions
};

/// What is kept of each limit cycle of a branch; see DirectLimitCycle.
struct BranchPoint {
  double speed;  ///< rad/s
  double frequency_Hz;
  double pad_velocity;        ///< m/s
  double pad_displacement;    ///< m
  double N_min;               ///< N
  double N_max;               ///< N
  double largest_multiplier;  ///< modulus, without the one along the cycle
};

/// The Hopf point in which a branch of limit cycles leaves stable sliding.
struct BranchOrigin {
  double speed;         ///< rad/s, at which stability is lost or regained
  double frequency_Hz;  ///< of the undamped oscillation there
  BranchPoint first;    ///< the small cycle beside it from which the branch was followed
};

/// Limit cycles over the speed, in the order along their branch.
struct LimitCycleBranch {
  std::vector<BranchPoint> points;
  /// Where the branch turns back: beyond such a speed two cycles, mostly a stable and an unstable
  /// one, have met and vanished.
  std::vector<BranchPoint> folds = {};
  /// The branch could not be followed from this speed (rad/s) to lower, or to higher ones.
  std::optional<double> lost_below = {};
  std::optional<double> lost_above = {};
  std::optional<BranchOrigin> origin = {};  ///< absent where the branch begins elsewhere
  std::string note = {};  ///< where it begins or goes on when not from its origin, and why
  /// Index of the first point that is not connected with those before it; absent where all are.
  std::optional<std::size_t> second_part = {};
};

}  // namespace chladni::squeal
