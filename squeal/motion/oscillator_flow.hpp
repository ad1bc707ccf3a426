#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// Modal coordinates and their rates.
struct ModalState {
  Eigen::VectorXd q;  ///< [n_modes]
  Eigen::VectorXd v;  ///< [n_modes] q'
};

/// Several modal states, one in each column.
struct ModalColumns {
  Eigen::MatrixXd q;  ///< [n_modes x n]
  Eigen::MatrixXd v;  ///< [n_modes x n]
};

/// The exact flow of q'' + C q' + diag(omega^2) q = 0 over a fixed time.
class OscillatorFlow {
 public:
  /// @param omega  [n_modes] rad/s
  /// @param C      [n_modes x n_modes] 1/s
  /// @param time   s
  OscillatorFlow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time);

  void advance(ModalState& x) const;
  void advance(ModalColumns& x) const;

 private:
  bool coupled_;
  Eigen::MatrixXd flow_;  ///< [2 n x 2 n] matrix exponential of coupled equations
  /// 2 x 2 blocks of the matrix exponential for uncoupled equations.
  Eigen::ArrayXd qq_, qv_, vq_, vv_;
};

}  // namespace chladni::squeal
