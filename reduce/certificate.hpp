#pragma once

#include <vector>

#include "reduce/completeness.hpp"

namespace chladni::reduce {

/// How good a reduced model is under the support that was asked for; the same on every rank.
struct Certificate {
  std::vector<double> lambda;       ///< [k] of the certified elastic modes, ascending; rad^2/s^2
  std::vector<double> eta2;         ///< [k] `ErrorEstimates`; empty where M_r is no projection
  std::vector<double> estimates;    ///< [k] of the relative errors of the frequencies, by place
  std::vector<double> rounding;     ///< [k] of lambda, relative
  std::vector<double> bounds;       ///< [<= k] of the errors of lambda that are counted
  EigenvalueCount fixed_interface;  ///< up to the last fixed-interface mode
  EigenvalueCount range;            ///< up to the last certified mode
  EigenvalueCount complete;         ///< the largest range looked at in which none is missing
  int n_zero = 0;                   ///< zero-energy motions without any support
  double zero_energy = 0.0;         ///< theirs over the first elastic lambda; 0 is perfect
  double condition = 0.0;           ///< estimate for K_ss
  double count_share = 0.0;         ///< of a count in the reduction's work
};

}  // namespace chladni::reduce
