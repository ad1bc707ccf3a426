#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hill.hpp"

namespace chladni::squeal {

/// Motions of a disc that need not be axisymmetric at one value of a parameter, by Hill's method.
struct ExponentSample {
  double value;          ///< value of the parameter
  double speed;          ///< rotation speed at that value, rad/s
  HillExponents motion;  ///< lambda[j] belongs to the same motion in all samples
  /// [n] integers that make lambda + i turns speed continuous in the parameter. They are needed
  /// because the replica chosen for a motion may change from value to value.
  Eigen::VectorXd turns;

  Eigen::Index size() const { return motion.lambda.size(); }
  double growth(Eigen::Index j) const { return motion.lambda[j].real(); }
  double frequency_Hz(Eigen::Index j) const;
  /// Growth within the estimated error does not count as instability.
  bool is_unstable(Eigen::Index j) const { return growth(j) > motion.error; }
  double doubt_of(Eigen::Index /*j*/) const { return motion.error; }
  StabilityPoint point(Eigen::Index j) const { return {value, growth(j), frequency_Hz(j)}; }
};

/// The exponents at a value of the parameter in any order, with turns = 0.
using ExponentsAt = std::function<ExponentSample(double value)>;

/// Samples at ascending values with one motion in each column. A motion is matched by the distance
/// of lambda from its extrapolation, modulo i nu speed. A change of the replica is penalised
/// slightly, so that motions of other frequencies are not mistaken for replicas.
/// @param values  [m], m > 0
std::vector<ExponentSample> followed_exponents(const ExponentsAt& exponents,
                                               const Eigen::VectorXd& values);

/// Intervals in which motion j grows. Extrema of the growth between samples that may cross zero are
/// located by interval halving, so that short intervals are found as well. A limit between two
/// samples is the root of the growth, within 1e-4 of their distance.
std::vector<UnstableInterval> unstable_intervals(const ExponentsAt& exponents,
                                                 const std::vector<ExponentSample>& samples,
                                                 Eigen::Index j);

}  // namespace chladni::squeal
