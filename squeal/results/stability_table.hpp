#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

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
