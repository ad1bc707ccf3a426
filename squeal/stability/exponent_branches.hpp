#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hill.hpp"

namespace chladni::squeal {

/// The motions of a disc of any kind at one value of a parameter, by Hill's method.
struct ExponentSample {
  double value;          ///< of the parameter
  double speed;          ///< rad/s, there
  HillExponents motion;  ///< lambda[j] of all samples is one motion
  /// [n] whole numbers: lambda + i turns speed is continuous in the parameter. The replica that
  /// turns with the motion may be another one at the next value.
  Eigen::VectorXd turns;

  Eigen::Index size() const { return motion.lambda.size(); }
  double growth(Eigen::Index j) const { return motion.lambda[j].real(); }
  double frequency_Hz(Eigen::Index j) const;
  /// Growth within the estimated error is none.
  bool is_unstable(Eigen::Index j) const { return growth(j) > motion.error; }
  double doubt_of(Eigen::Index /*j*/) const { return motion.error; }
  StabilityPoint point(Eigen::Index j) const { return {value, growth(j), frequency_Hz(j)}; }
};

/// The exponents at a value of the parameter, in any order, with turns of 0.
using ExponentsAt = std::function<ExponentSample(double value)>;

/// The samples at the rising values, each motion in one column: nearest to the extrapolation of
/// lambda from the two values before, modulo i nu speed. A change of the replica costs a little, so
/// that motions of other frequencies are not taken for replicas.
/// @param values  [m], m > 0
std::vector<ExponentSample> followed_exponents(const ExponentsAt& exponents,
                                               const Eigen::VectorXd& values);

/// The intervals in which motion j grows, also those between the samples: where three of them have
/// an extremum of the growth in the middle that may pass zero, it is approached by halving. A limit
/// between two samples is the root of the growth, to 1e-4 of their distance.
std::vector<UnstableInterval> unstable_intervals(const ExponentsAt& exponents,
                                                 const std::vector<ExponentSample>& samples,
                                                 Eigen::Index j);

}  // namespace chladni::squeal
