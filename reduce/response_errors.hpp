#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "reduce/mixed_interface.hpp"

namespace chladni::reduce {

/// Harmonic loads on free masters and the sizes that the errors of their responses are relative to.
struct ResponseLoads {
  Eigen::MatrixXd F;      ///< [n_m x l] unit loads, rows as the masters of a model
  Eigen::VectorXd Omega;  ///< [g + 1] rad/s, ascending: ends of bands up to the end of the range
  Eigen::MatrixXd size;   ///< [l x g] what the length of each column of responses is not below
  double loss_factor;     ///< the largest one of the damping with which responses are compared
};

/// A tolerance for the responses u = F^T (K (1 + i eta) - Omega^2 M)^-1 F of loaded masters,
/// against the FE model, for all frequencies of a range and all loss factors eta up to the largest
/// one.
struct ResponseGoal {
  double Omega;      ///< end of the range, rad/s
  double tolerance;  ///< of the error of each column of u, relative to its size
  /// Returns the loads, given a model that has the modes of the range. Called on the first rank
  /// only, for each model anew.
  std::function<ResponseLoads(const ReducedModel& model)> loads;
};

/// The accuracy of a model's responses for a goal.
struct ResponseCertificate {
  double Omega = 0.0;  ///< end of the range, rad/s; 0 if nothing was checked
  double error = 0.0;  ///< the largest bound, relative to its size
  int n_loads = 0;
  int n_added = 0;  ///< number of shapes added to keep the tolerance
};

/// A basis and its model, to which shapes may still be added.
struct RespondingModel {
  CraigBamptonBasis& Q_CB;
  ReducedModel& model;
};

/// Adds shapes to the basis until all bounds are below the tolerance: each time those of the
/// largest errors, in the middle of the band where they are largest.
/// @param held             rows of the masters that the support holds, ascending
/// @param lambda_left_out  rad^2/s^2; the FE model's first eigenvalue under that support whose mode
///                         is not in the basis
/// @note   Collective.
/// @throws chladni::Error on all ranks when a mode of the range is left out.
ResponseCertificate keep_responses(const WholeSystem& body, const RespondingModel& made,
                                   const std::vector<int>& held, double lambda_left_out,
                                   const ResponseGoal& goal);

}  // namespace chladni::reduce
