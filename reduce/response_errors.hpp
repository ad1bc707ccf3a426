#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "reduce/mixed_interface.hpp"

namespace chladni::reduce {

/// Harmonic loads on free masters, and what errors of their responses are relative to.
struct ResponseLoads {
  Eigen::MatrixXd F;      ///< [n_m x l] unit loads, rows as the masters of a model
  Eigen::VectorXd Omega;  ///< [g] rad/s, ascending, up to the end of the range
  Eigen::MatrixXd size;   ///< [l x g] of each column of responses, the least around each frequency
};

/// Responses of loaded masters to harmonic loads there, u = F^T (K - Omega^2 M)^-1 F, that are to
/// be those of the FE model.
struct ResponseGoal {
  double Omega;      ///< end of the range, rad/s
  double tolerance;  ///< of the error of each column of u, over its size
  /// For a first model that has the modes of the range. Asked on the first rank only.
  std::function<ResponseLoads(const ReducedModel& model)> loads;
};

/// Upper bounds of the lengths of the columns of the error E of the responses u. The model holds
/// all modes of the FE model below lambda_left_out > Omega^2 and all static shapes of the loaded
/// masters: E = r^T (K - Omega^2 M)^-1 r lies between G and c G in the order of semidefinite
/// matrices, c = 1 / (1 - Omega^2 / lambda_left_out), for the spectrum that r sees begins there.
/// Hence |E e_j| <= |G e_j| + (c - 1) sqrt(|G| G_jj).
/// @return [l]
Eigen::VectorXd response_error_bounds(const Eigen::MatrixXd& G, double Omega,
                                      double lambda_left_out);

/// How well a model keeps a goal.
struct ResponseCertificate {
  double Omega = 0.0;  ///< end of the range, rad/s; 0 where nothing is known
  double error = 0.0;  ///< the largest bound over its size
  int n_loads = 0;
  int n_added = 0;  ///< shapes that were added to keep the tolerance
};

/// A basis in the middle of its making.
struct RespondingModel {
  CraigBamptonBasis& Q_CB;
  ReducedModel& model;
};

/// Adds to the basis, while a bound is above the tolerance, the shapes of the largest errors at the
/// frequency where they are largest.
/// @param held             rows of the masters that the support holds, ascending
/// @param lambda_left_out  the FE model's first eigenvalue under that support whose mode is not in
///                         the basis
/// @throws chladni::Error on all ranks when a mode of the range is left out.
/// @note   Collective.
ResponseCertificate keep_responses(const WholeSystem& body, const RespondingModel& made,
                                   const std::vector<int>& held, double lambda_left_out,
                                   const ResponseGoal& goal);

}  // namespace chladni::reduce
