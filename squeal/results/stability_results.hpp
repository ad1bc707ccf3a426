#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Eigenvalues with Im >= 0 of the sliding disc, each column followed over the speed.
struct EigenvalueMap {
  Eigen::VectorXd speeds;   ///< [m] rad/s
  Eigen::MatrixXcd lambda;  ///< [m x n_modes] growth rate 1/s + i angular frequency rad/s
  /// [m] of [n_modes x n_modes]: column j is the complex shape of eigenvalue j as in
  /// `LimitCycle::amplitude`, then of pads with a mass; norm 1. Empty for models without a body.
  std::vector<Eigen::MatrixXcd> shapes = {};
  std::vector<int> mode_numbers = {};  ///< 1-based in the body; empty without shapes, in old files
  /// Of a disc that is not axisymmetric "mean matrix" or "worst frozen angle"; else empty.
  std::string of = {};
  Eigen::VectorXd angles = {};  ///< [m] rad, at which such a disc stands; else empty
};

/// The least stable motion of the sliding disc at one value of a parameter.
struct StabilityPoint {
  double value;            ///< in the unit of the parameter
  double growth;           ///< growth rate, 1/s; 0 at a limit of stability
  double frequency_Hz;     ///< of the motion
  int n_newton_steps = 0;  ///< Newton steps to a limit of stability; 0: bisection only
};

/// An interval of a parameter in which the sliding disc is unstable.
struct UnstableInterval {
  StabilityPoint from, to;  ///< limits of stability, or ends of the searched range
  StabilityPoint worst;     ///< largest growth among the computed values
};

/// Stability of the sliding disc over a range of a parameter; see stability_search.hpp.
struct StabilityProfile {
  StabilityPoint from, to;                 ///< ends of the range
  std::vector<UnstableInterval> unstable;  ///< by ascending values
  std::string method = {};  ///< "hill" for discs that are not axisymmetric, else empty
};

/// Stability over a range of a parameter.
enum class Stability {
  stable,    ///< in the whole range
  unstable,  ///< in the whole range
  lost,      ///< becomes unstable at a value within the range
  regained   ///< unstable at the lower end, becomes stable within the range
};

/// Lowest value at which stability is lost: unstable just above, stable just below.
std::optional<StabilityPoint> first_loss(const StabilityProfile& profile);

/// Lowest value at which stability is regained: unstable just below.
std::optional<StabilityPoint> first_regain(const StabilityProfile& profile);

/// Classifies the profile.
Stability stability_of(const StabilityProfile& profile);

/// The stability in words, such as "stable in the whole range" or "lost within the range".
const char* name_of(Stability stability);

/// Estimated error of a result, in its unit; unknown parts are absent.
struct ErrorBudget {
  std::optional<double> mesh = {};       ///< by the mesh, from finer meshes
  std::optional<double> reduction = {};  ///< by the reduction, compared with the FE model
  std::optional<double> body = {};       ///< by the modes that the body lacks
  /// Difference to the value with all modes of the body, if the study selected modes.
  std::optional<double> left_out = {};
  std::optional<double> integration = {};  ///< by the integration of a periodic motion

  bool is_empty() const { return !mesh && !reduction && !body && !left_out && !integration; }
  double sum() const
  {
    return mesh.value_or(0.0) + reduction.value_or(0.0) + body.value_or(0.0) +
           left_out.value_or(0.0) + integration.value_or(0.0);
  }
};

/// Lowest speed at which the sliding disc loses its stability.
struct CriticalSpeed {
  double speed;            ///< rad/s
  double frequency_Hz;     ///< frequency of the undamped oscillation
  int n_newton_steps = 0;  ///< 0: by bisection, because Newton's method left the bracket
  ErrorBudget budget = {};
};

/// Value of a parameter at which the sliding disc loses or regains its stability.
struct CriticalValue {
  std::string parameter;        ///< `key_of` a MapParameter
  double speed;                 ///< rad/s
  std::optional<double> value;  ///< lowest loss of stability, else lowest regain; absent: neither
  double frequency_Hz;          ///< frequency of the undamped oscillation
  int n_newton_steps;
  std::optional<StabilityProfile> profile = {};  ///< absent in files of earlier versions
};

/// Least stable eigenvalue of the sliding disc over the speed and another parameter.
struct StabilityMap {
  std::string parameter;             ///< `key_of` a MapParameter
  Eigen::VectorXd values;            ///< [m] in the unit of the parameter
  Eigen::VectorXd speeds;            ///< [n] rad/s
  Eigen::MatrixXd growth;            ///< [m x n] largest growth rate, 1/s
  Eigen::MatrixXd frequency_Hz;      ///< [m x n] frequency of the least stable oscillation
  std::string method = {};           ///< "hill" for discs that are not axisymmetric, else empty
  std::optional<double> error = {};  ///< estimated, of the growth rates by Hill's method, 1/s
};

/// Stability of a disc that need not be axisymmetric over the speed; see rotation_stability.hpp.
struct RotationStability {
  Eigen::VectorXd speeds;  ///< [m] rad/s
  Eigen::VectorXd growth;  ///< [m] largest growth rate, 1/s
  /// [m] of the least stable motion, in the inertial frame (Hill) or the frame of the disc
  /// (Floquet).
  Eigen::VectorXd frequency_Hz;
  std::optional<double> critical_speed;  ///< lowest speed with growth, rad/s
  std::string method = {};  ///< "hill" or "floquet"; empty in files of earlier versions: floquet
  int harmonics = 0;        ///< largest K of Hill's method over the speeds
  double error = 0.0;       ///< largest estimated error of the growth by Hill's method, 1/s
  /// [m x r] exponents of Hill's method by descending growth, 1/s + i rad/s; empty for Floquet's.
  Eigen::MatrixXcd exponents = {};
  /// [m] largest growth rate of the disc at rest over its angles, 1/s; empty in earlier files.
  Eigen::VectorXd frozen_growth = {};
};

/// Stability with the lowest modes only.
struct ModeSubset {
  int n_modes;
  double highest_Hz;
  std::optional<double> critical_speed;         ///< rad/s; absent when there is none in the range
  std::optional<double> critical_frequency_Hz;  ///< frequency of the oscillation
  double growth;               ///< largest growth rate at the critical speed of all modes, 1/s
  std::string stability = {};  ///< over the speed, as name_of(Stability)
};

/// Effect of one mode, or pair of modes, on the critical oscillation with all modes.
struct ModeInfluence {
  int nodal_diameters;
  double frequency_Hz;   ///< of the mode
  double participation;  ///< fraction of the kinetic energy of the critical oscillation
  /// Growth rate at the critical speed without the mode, 1/s; absent if it dominates the
  /// oscillation.
  std::optional<double> growth_without;
  std::optional<double> critical_speed_without;  ///< rad/s
};

/// Influence of the modes on the critical speed.
struct ModeSensitivity {
  double critical_speed;  ///< with all modes, rad/s
  double critical_frequency_Hz;
  std::vector<ModeSubset> subsets;        ///< with the lowest 2, 8, 16 and with all modes
  std::vector<ModeInfluence> influences;  ///< by ascending frequency
};

/// Work per period of a growing or decaying oscillation relative to its energy. Both are averaged
/// over the phase at a constant amplitude. The sum is 2 * growth / frequency.
struct PeriodWork {
  double friction;  ///< work of the friction of all pads; > 0 feeds the oscillation
  double normal;    ///< work of the normal forces
  double damping;   ///< work of the modal damping and of the pads' suspensions
};

/// One motion of the sliding brake, followed by its shape over the values of a parameter.
struct StabilityBranch {
  Eigen::VectorXcd lambda;                 ///< [m] growth rate 1/s + i angular frequency rad/s
  std::vector<UnstableInterval> unstable;  ///< by ascending values; empty: stable at all values
  StabilityPoint worst;                    ///< largest growth among the computed values
  /// [n_families] fraction of the kinetic energy at `worst` in each family; empty without families.
  Eigen::VectorXd shares;
  double pads = 0.0;  ///< fraction in pads with a mass
  /// At `worst`; absent for stable branches and without families.
  std::optional<PeriodWork> work = {};
  /// Of `worst.growth`, 1/s; empty for stable branches, by Hill's method and without a body.
  ErrorBudget budget = {};

  bool is_unstable() const { return !unstable.empty(); }
};

/// A pair of modes of the disc, or a single mode without nodal diameters.
struct ModeFamily {
  int nodal_diameters;
  double frequency_Hz;
  /// Nodal circles of the axial motion; absent when the body has no picture, for in-plane modes,
  /// and in files of earlier versions.
  std::optional<int> nodal_circles = {};
  /// In-plane fraction of the kinetic energy; absent if unknown.
  std::optional<double> in_plane = {};
};

/// All motions of the sliding brake with a frequency in the band at some value of a parameter.
struct StabilityTable {
  std::string parameter;              ///< "speed", or `key_of` a MapParameter
  std::optional<double> speed;        ///< speed of a table over another parameter, rad/s
  std::optional<FrequencyBand> band;  ///< absent: all motions
  Eigen::VectorXd values;             ///< [m] in the unit of the parameter; rad/s for the speed
  /// Modes of the disc by ascending frequency; empty without a body.
  std::vector<ModeFamily> families;
  std::vector<StabilityBranch> branches;  ///< by ascending frequency at `worst`
  /// "eigenvalues", or "hill" for discs that are not axisymmetric, then without families, shares
  /// and works. Empty in files of earlier versions, which used eigenvalues.
  std::string method = {};
  double error = 0.0;  ///< estimated error of the growth rates by Hill's method, 1/s

  bool is_by_hill() const { return method == "hill"; }
};

/// Damping ratio -growth / |lambda| of the oscillation; negative when it grows.
double damping_ratio(const StabilityPoint& point);

/// Whether the branch is unstable at all values of the table.
bool is_always_unstable(const StabilityTable& table, const StabilityBranch& branch);

/// Number of nodal diameters with the largest share of the branch's energy; absent without a body.
std::optional<int> nodal_diameters(const StabilityTable& table, const StabilityBranch& branch);

/// Number of nodal circles of the family that has the largest share among those with the nodal
/// diameters of the branch; absent if unknown.
std::optional<int> nodal_circles(const StabilityTable& table, const StabilityBranch& branch);

/// In-plane fraction of the disc's kinetic energy in the branch; absent when it is unknown for a
/// family.
std::optional<double> in_plane_share(const StabilityTable& table, const StabilityBranch& branch);

/// A sentence on the table, such as "no mode is unstable at any speed of the range" or "4 of 35
/// modes are unstable somewhere".
std::string summary(const StabilityTable& table);

}  // namespace chladni::squeal
