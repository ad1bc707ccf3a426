#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Works in one period of a growing or decaying oscillation, relative to its energy: both are means
/// over the phase, with the amplitude of one moment. The sum is 2 * growth / frequency.
struct PeriodWork {
  double friction;  ///< of the friction of all pads; > 0 feeds the oscillation
  double normal;    ///< of their normal forces
  double damping;   ///< of the modes of the disc and of the suspensions of pads
};

/// One motion of the sliding brake, followed by its shape over the values of a parameter.
struct StabilityBranch {
  Eigen::VectorXcd lambda;                 ///< [m] growth rate 1/s + i angular frequency rad/s
  std::vector<UnstableInterval> unstable;  ///< by rising values; empty: stable at all values
  StabilityPoint worst;    ///< where its growth was largest among the values that were looked at
  Eigen::VectorXd shares;  ///< [n_families] of its kinetic energy there; empty without families
  double pads = 0.0;       ///< the share of pads with a mass
  std::optional<PeriodWork> work = {};  ///< there; absent of stable ones and without families

  bool is_unstable() const { return !unstable.empty(); }
};

/// A pair of modes of the disc, or a mode without nodal diameters.
struct ModeFamily {
  int nodal_diameters;
  double frequency_Hz;
  /// Of the motion along the axis; absent where the body has no picture, for modes in the plane,
  /// and in files of earlier versions.
  std::optional<int> nodal_circles = {};
  std::optional<double> in_plane = {};  ///< share of its kinetic energy; absent where it is unknown
};

/// All motions of the sliding brake that have a frequency of the band at some value of a parameter.
struct StabilityTable {
  std::string parameter;              ///< "speed", or `key_of` a MapParameter
  std::optional<double> speed;        ///< of a table over another parameter, rad/s
  std::optional<FrequencyBand> band;  ///< absent: all motions
  Eigen::VectorXd values;             ///< [m] of the parameter: rad/s, 1, N or N/m
  std::vector<ModeFamily> families;   ///< of the disc, by rising frequency; empty without a body
  std::vector<StabilityBranch> branches;  ///< by rising frequency at their worst value
  /// "eigenvalues", or "hill" for discs that are not axisymmetric: then without families, shares
  /// and works; empty in files of earlier versions: eigenvalues.
  std::string method = {};
  double error = 0.0;  ///< of the growth rates by Hill's method, estimated, 1/s

  bool is_by_hill() const { return method == "hill"; }
};

/// The ratio -growth / |lambda| of the decaying or growing oscillation; negative where it grows.
double damping_ratio(const StabilityPoint& point);

/// Whether the branch is unstable at all values of the table.
bool is_always_unstable(const StabilityTable& table, const StabilityBranch& branch);

/// The number of nodal diameters whose modes of the disc have the largest share of the branch;
/// absent without a body.
std::optional<int> nodal_diameters(const StabilityTable& table, const StabilityBranch& branch);

/// Of the family with so many nodal diameters that has the largest share; absent where that is
/// unknown.
std::optional<int> nodal_circles(const StabilityTable& table, const StabilityBranch& branch);

/// The share of motion in the plane in the kinetic energy of the disc; absent where it is unknown
/// of a family.
std::optional<double> in_plane_share(const StabilityTable& table, const StabilityBranch& branch);

/// "no mode is unstable at any speed of the range" or "4 of 35 modes are unstable somewhere".
std::string summary(const StabilityTable& table);

}  // namespace chladni::squeal
