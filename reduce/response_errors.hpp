#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "reduce/mixed_interface.hpp"

namespace chladni::reduce {

/// Harmonic loads on free masters and the sizes that the errors of their responses are relative to.
struct ResponseLoads {
  Eigen::MatrixXd F;      ///< [n_m x l] unit loads, rows as the masters of a model
  Eigen::VectorXd Omega;  ///< [g] rad/s, ascending, up to the end of the range
  /// [l x g] length of each column of responses: its minimum around each frequency.
  Eigen::MatrixXd size;
};

/// A tolerance for the responses u = F^T (K - Omega^2 M)^-1 F of loaded masters, against the FE
/// model.
struct ResponseGoal {
  double Omega;      ///< end of the range, rad/s
  double tolerance;  ///< of the error of each column of u, relative to its size
  /// Returns the loads, given a first model that has the modes of the range. Called on the first
  /// rank only.
  std::function<ResponseLoads(const ReducedModel& model)> loads;
};

/// Upper bounds of the lengths of the columns of E, the error of the responses u. The model must
/// hold all modes of the FE model below lambda_left_out > Omega^2 and all static shapes of the
/// loaded masters. Then E = r^T (K - Omega^2 M)^-1 r lies between G and c G in the order of
/// semidefinite matrices with c = 1 / (1 - Omega^2 / lambda_left_out), because the spectrum that r
/// excites begins at lambda_left_out. Hence |E e_j| <= |G e_j| + (c - 1) sqrt(|G| G_jj).
/// @param G                [l x l] `ResidualForms::energy`
/// @param Omega            rad/s
/// @param lambda_left_out  rad^2/s^2
/// @return [l]
Eigen::VectorXd response_error_bounds(const Eigen::MatrixXd& G, double Omega,
                                      double lambda_left_out);

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
/// largest errors, at the frequency where they are largest.
/// @param held             rows of the masters that the support holds, ascending
/// @param lambda_left_out  rad^2/s^2; the FE model's first eigenvalue under that support whose mode
///                         is not in the basis
/// @note   Collective.
/// @throws chladni::Error on all ranks when a mode of the range is left out.
ResponseCertificate keep_responses(const WholeSystem& body, const RespondingModel& made,
                                   const std::vector<int>& held, double lambda_left_out,
                                   const ResponseGoal& goal);

}  // namespace chladni::reduce
