#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

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
  /// 1-based in the body, of the first rows of the shapes; empty without shapes and in files of
  /// earlier versions.
  std::vector<int> mode_numbers = {};
};

/// The least stable motion of the sliding disc at one value of a parameter.
struct StabilityPoint {
  double value;            ///< of the parameter, in its unit
  double growth;           ///< 1/s; 0 where stability is lost or regained
  double frequency_Hz;     ///< of the motion
  int n_newton_steps = 0;  ///< that led to a limit of stability; 0: bisection alone
};

/// An interval of a parameter in which the sliding disc is unstable.
struct UnstableInterval {
  StabilityPoint from, to;  ///< limits of stability, or ends of the range that was searched
  StabilityPoint worst;     ///< where the growth was largest among the values that were looked at
};

/// Stability of the sliding disc over a range of one parameter; see stability_search.hpp.
struct StabilityProfile {
  StabilityPoint from, to;                 ///< the ends of the range
  std::vector<UnstableInterval> unstable;  ///< by rising values
  std::string method = {};  ///< "hill" for discs that are not axisymmetric; else empty
};

/// What a range of a parameter does to the stability.
enum class Stability {
  stable,    ///< in the whole range
  unstable,  ///< in the whole range
  lost,      ///< the range holds a value from which on sliding is unstable
  regained   ///< unstable at the lower end, and stable from a value of the range on
};

/// The lowest value of the range at which stability is lost: unstable just above, not just below.
std::optional<StabilityPoint> first_loss(const StabilityProfile& profile);

/// The lowest value of the range at which stability is regained: unstable just below.
std::optional<StabilityPoint> first_regain(const StabilityProfile& profile);

Stability stability_of(const StabilityProfile& profile);

/// "stable in the whole range", "unstable in the whole range", "lost within the range" or
/// "regained within the range".
const char* name_of(Stability stability);

/// How far a critical speed may be off because of what the body is made of, rad/s; parts of which
/// nothing is known are absent.
struct ErrorBudget {
  std::optional<double> mesh = {};       ///< of the frequencies, estimated by finer meshes
  std::optional<double> reduction = {};  ///< of the frequencies, against the FE model
  std::optional<double> body = {};       ///< of the responses of the modes that the body keeps
  /// The distance from the critical speed of all modes of the body, where the study chose some.
  std::optional<double> left_out = {};

  bool is_empty() const { return !mesh && !reduction && !body && !left_out; }
  double sum() const
  {
    return mesh.value_or(0.0) + reduction.value_or(0.0) + body.value_or(0.0) +
           left_out.value_or(0.0);
  }
};

/// The lowest speed at which the sliding disc loses its stability.
struct CriticalSpeed {
  double speed;            ///< rad/s
  double frequency_Hz;     ///< of the undamped oscillation there
  int n_newton_steps = 0;  ///< 0: it was bisected, because Newton's method led elsewhere
  ErrorBudget budget = {};
};

/// Where the sliding disc loses or regains its stability over one parameter.
struct CriticalValue {
  std::string parameter;  ///< `key_of` a MapParameter
  double speed;           ///< rad/s
  /// The lowest value at which stability is lost, else the lowest at which it is regained: 1, N or
  /// N/m; absent when there is neither in the range.
  std::optional<double> value;
  double frequency_Hz;  ///< of the undamped oscillation there
  int n_newton_steps;
  std::optional<StabilityProfile> profile = {};  ///< absent in files of earlier versions
};

/// The least stable eigenvalue of the sliding disc over the speed and one more parameter.
struct StabilityMap {
  std::string parameter;         ///< `key_of` a MapParameter
  Eigen::VectorXd values;        ///< [m] of it: 1, N or N/m
  Eigen::VectorXd speeds;        ///< [n] rad/s
  Eigen::MatrixXd growth;        ///< [m x n] largest growth rate, 1/s
  Eigen::MatrixXd frequency_Hz;  ///< [m x n] of the oscillation with it
};

/// Stability of a sliding disc of any kind over the speed; see rotation_stability.hpp.
struct RotationStability {
  Eigen::VectorXd speeds;  ///< [m] rad/s
  Eigen::VectorXd growth;  ///< [m] largest growth rate, 1/s
  /// [m] of the motion with it: in the inertial frame by Hill's method, in the frame of the disc by
  /// Floquet's.
  Eigen::VectorXd frequency_Hz;
  std::optional<double> critical_speed;  ///< the first from which it grows, rad/s
  std::string method = {};  ///< "hill" or "floquet"; empty in files of earlier versions: floquet
  int harmonics = 0;        ///< K of Hill's method, the largest over the speeds
  double error = 0.0;       ///< of the growth by Hill's method, estimated, the largest, 1/s
  /// [m x r] the worst exponents by Hill's method, by falling growth: growth rate 1/s + i angular
  /// frequency rad/s; empty by Floquet's.
  Eigen::MatrixXcd exponents = {};
  /// [m] largest growth rate of the disc that stands at some angle, 1/s; empty in files of earlier
  /// versions.
  Eigen::VectorXd frozen_growth = {};
};

/// What the lowest modes alone would say.
struct ModeSubset {
  int n_modes;
  double highest_Hz;
  std::optional<double> critical_speed;         ///< rad/s; absent when there is none in the range
  std::optional<double> critical_frequency_Hz;  ///< of the oscillation there
  double growth;               ///< largest growth rate at the critical speed of all modes, 1/s
  std::string stability = {};  ///< over the speed, in the words of name_of(Stability)
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

}  // namespace chladni::squeal
