#pragma once

#include <Eigen/Core>

#include <vector>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::reduce {

/// The dynamic stiffness A(Omega) = K (1 + i eta) + i H + i Omega (C + alpha M + beta K) - Omega^2
/// M.
struct HarmonicModel {
  Mat K, M;
  Mat C = nullptr;           ///< viscous damping, or none
  Mat H = nullptr;           ///< structural damping by loss factors of parts, or none
  double loss_factor = 0.0;  ///< eta
  double alpha = 0.0;        ///< 1/s
  double beta = 0.0;         ///< s

  bool is_damped() const
  {
    return C != nullptr || H != nullptr || loss_factor > 0.0 || alpha > 0.0 || beta > 0.0;
  }
};

/// A linear form sum_k weights[k] u[dofs[k]]: a load, or an output. The same on every rank.
struct DofForm {
  /// Global DOFs. Held ones are ignored.
  std::vector<PetscInt> dofs;
  std::vector<double> weights;
};

/// Thrown when an undamped model is excited at a natural frequency.
class Resonance : public Error {
 public:
  using Error::Error;
};

/// Responses of the FE model itself, U^T A(Omega)^-1 F, with sparse loads F and outputs U. Each
/// frequency costs one factorisation L D L^T by MUMPS; all use the elimination order of the first.
/// A damped model is solved in real arithmetic as [Re A, -Im A; -Im A, -Re A] (x, y) = (f, 0), u =
/// x + i y. The two numbers of a DOF are neighbours, so that each rank keeps its DOFs.
class HarmonicResponse {
 public:
  /// @note   Collective.
  HarmonicResponse(const HarmonicModel& model, const FreeDofs& free,
                   const std::vector<DofForm>& loads, const std::vector<DofForm>& outputs,
                   linear::OptionSource source = {});

  /// The responses at one frequency.
  /// @param  Omega  rad/s
  /// @return [n_outputs x n_loads], on every rank
  /// @note   Collective.
  /// @throws Resonance when the model is undamped and |K v| exceeds 1e8 times its load.
  /// @throws chladni::Error when the factor is missing or inaccurate.
  /// Options: `-<prefix>response_mat_mumps_...`
  Eigen::MatrixXcd at(double Omega);

 private:
  /// The part of an output that one local row of the solution gives: weight times that row.
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
  HarmonicModel factors_;        ///< eta, alpha and beta only
  petsc::Matrix A_, E_;
  petsc::LinearSolver solver_;  ///< empty before the first frequency
  linear::OptionSource source_;
  std::vector<Share> shares_;
  Eigen::Index n_outputs_;
};

/// V = (K - Omega_0^2 M)^-1 E: responses of the free system to harmonic unit loads E on some DOFs.
/// They are the frequency-response modes in the space of the whole model. One factorisation.
/// @param Omega_0  rad/s
/// @param loaded   global DOFs, the same list on every rank
/// @return [n x n_loads] dense, rows as K; m/N and the like
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when Omega_0 is an eigenfrequency of the model to round-off.
petsc::Matrix full_responses(Mat K, Mat M, double Omega_0, const std::vector<PetscInt>& loaded);

/// Harmonic unit loads at one excitation frequency.
struct HarmonicLoads {
  double Omega_0;                ///< rad/s
  std::vector<PetscInt> loaded;  ///< global DOFs, the same list on every rank
};

/// The responses to several sets of loads, side by side; one factorisation for each set.
/// @return [n x all n_loads] dense, rows as K
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error as the function above.
/// Options: `-<prefix>response_mat_mumps_...`
petsc::Matrix full_responses(Mat K, Mat M, const std::vector<HarmonicLoads>& loads,
                             const linear::OptionSource& source = {});

/// The blocks K_ss and M_ss.
struct SlaveBlocks {
  Mat K, M;
};

/// Fixed-interface modes with further columns.
struct Enrichment {
  FixedInterfaceModes modes;  ///< Phi and omega with the new columns behind the others
  PetscInt n_added;           ///< less than columns of V if these depend on the basis or each other
};

/// Adds columns X to Phi, so that the span of [I 0; Psi Phi X] holds V. X is zero at the masters as
/// Phi is, with Phi^T M_ss X = 0, X^T M_ss X = I and X^T K_ss X = diag(omega^2): the reduced model
/// keeps its form. The omega of X are Rayleigh quotients and no frequencies of the model. Pass all
/// vectors at once: columns of a second call would not be K-orthogonal to those of the first.
/// @param V  [n x k] dense, rows as the whole system
/// @note   Collective.
Enrichment enrich(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, const SlaveBlocks& ss,
                  Mat V);

}  // namespace chladni::reduce
