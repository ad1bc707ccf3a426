#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::reduce {

/// A(Omega) = K (1 + i eta) + i H + i Omega (C + alpha M + beta K) - Omega^2 M.
struct HarmonicModel {
  Mat K, M;
  Mat C = nullptr;           ///< of dampers, or none
  Mat H = nullptr;           ///< structural damping by loss factors of parts, or none
  double loss_factor = 0.0;  ///< eta
  double alpha = 0.0;        ///< 1/s
  double beta = 0.0;         ///< s

  bool is_damped() const
  {
    return C != nullptr || H != nullptr || loss_factor > 0.0 || alpha > 0.0 || beta > 0.0;
  }
};

/// A load, or a motion that is asked for: sum_k weights[k] u[dofs[k]]. The same on every rank.
struct DofForm {
  std::vector<PetscInt> dofs;  ///< global; what supports hold takes no part
  std::vector<double> weights;
};

/// An undamped model in resonance.
class Resonance : public Error {
 public:
  using Error::Error;
};

/// Responses of the FE model itself: U^T A(Omega)^-1 F of sparse loads F and outputs U. One
/// factorisation L D L^T by MUMPS for each frequency, all in the order of the first one. PETSc's
/// build is real: a damped model is solved as [Re A, -Im A; -Im A, -Re A] (x, y) = (f, 0), u = x +
/// i y, with the two numbers of a DOF behind each other, so that ranks keep their DOFs.
class HarmonicResponse {
 public:
  /// @note   Collective.
  HarmonicResponse(const HarmonicModel& model, const FreeDofs& free,
                   const std::vector<DofForm>& loads, const std::vector<DofForm>& outputs,
                   linear::OptionSource source = {});

  /// @param  Omega  rad/s
  /// @return [n_outputs x n_loads], on every rank
  /// @note   Collective.
  /// @throws Resonance where an undamped K v is above 1e8 times its load.
  /// @throws chladni::Error when there is no factor.
  /// Options: `-<prefix>response_mat_mumps_...`
  Eigen::MatrixXcd at(double Omega);

 private:
  /// What a rank adds to an output: weight times a local row of the solution.
  struct Share {
    Eigen::Index output;
    PetscInt row;
    double weight;
  };

  void set_values(double Omega);
  void check_resonance(double Omega, Mat V) const;
  Eigen::MatrixXcd outputs_of(Mat V) const;

  PetscInt width_;               ///< numbers for each DOF: 1 undamped, 2 damped
  petsc::Matrix K_, M_, C_, H_;  ///< of the free DOFs, all with the pattern of their sum
  HarmonicModel factors_;        ///< eta, alpha and beta
  petsc::Matrix A_, E_;
  petsc::LinearSolver solver_;  ///< once there was a frequency
  linear::OptionSource source_;
  std::vector<Share> shares_;
  Eigen::Index n_outputs_;
};

}  // namespace chladni::reduce
