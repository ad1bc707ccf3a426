#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <string_view>

namespace chladni::fmu {

/// A body in modal coordinates q under forces and moments F at some of its DOFs:
/// q'' + C q' + diag(omega^2) q = Phi^T F, u = Phi q.
struct ModalModel {
  std::string token;      ///< export token, the same as in modelDescription.xml
  Eigen::VectorXd omega;  ///< [n_modes], rad/s
  Eigen::MatrixXd C;      ///< [n_modes x n_modes], 1/s, or [0 x 0]
  Eigen::MatrixXd Phi;    ///< [n_dofs x n_modes], m or rad per unit of q

  Eigen::Index n_modes() const { return omega.size(); }
  Eigen::Index n_dofs() const { return Phi.rows(); }
};

/// Name of the model's file among the resources of its FMU.
inline constexpr auto model_file = "body.chladni-fmu";

/// The model as bytes, with numbers in the byte order of this machine; see
/// docs/reference/file_formats.md.
std::string packed(const ModalModel& model);

/// The model that `packed` wrote.
/// @throws chladni::Error when the bytes are not a model or are incomplete.
ModalModel unpacked(std::string_view bytes);

/// Value references of the variables. Each group has one reference for each DOF or mode; each
/// function returns the first reference of its group.
class References {
 public:
  References(Eigen::Index n_modes, Eigen::Index n_dofs)
      : n_modes_(static_cast<std::uint32_t>(n_modes)), n_dofs_(static_cast<std::uint32_t>(n_dofs))
  {}
  static constexpr std::uint32_t time = 0, damping_factor = 1;
  std::uint32_t damping_ratios() const { return 2; }
  std::uint32_t forces() const { return damping_ratios() + n_modes_; }
  std::uint32_t displacements() const { return forces() + n_dofs_; }
  std::uint32_t velocities() const { return displacements() + n_dofs_; }
  std::uint32_t accelerations() const { return velocities() + n_dofs_; }
  std::uint32_t q() const { return accelerations() + n_dofs_; }
  std::uint32_t q_dot() const { return q() + n_modes_; }
  std::uint32_t der_q() const { return q_dot() + n_modes_; }
  std::uint32_t der_q_dot() const { return der_q() + n_modes_; }
  /// One past the last reference.
  std::uint32_t end() const { return der_q_dot() + n_modes_; }

 private:
  std::uint32_t n_modes_, n_dofs_;
};

/// Exact step of modal coordinates and rates x = (q, q') over the time h under modal forces f that
/// are constant during the step: x(t + h) = from_state x(t) + from_force f.
struct Propagator {
  Eigen::MatrixXd from_state;  ///< [2n x 2n]
  Eigen::MatrixXd from_force;  ///< [2n x n]
};

/// The propagator of q'' + C q' + diag(omega^2) q = f from the matrix exponential of h [A, B; 0,
/// 0], mode by mode when C is diagonal. omega = 0 is allowed.
/// @param h  step size, s, > 0
Propagator propagator(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double h);

}  // namespace chladni::fmu
