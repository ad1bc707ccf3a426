#pragma once

#include <vector>

#include "reduce/support.hpp"

namespace chladni::reduce {

/// Orthonormal combinations of motions that leave some of their rows at rest.
/// @param R     [n x r] linearly independent columns
/// @param rows  ascending
Eigen::MatrixXd at_rest(const Eigen::MatrixXd& R, const std::vector<int>& rows);

/// The others of 0 .. n - 1, ascending.
/// @param rows  ascending
std::vector<int> all_but(const std::vector<int>& rows, Eigen::Index n);

/// The rows of some masters in the models, whose masters ascend by DOF.
/// @param masters  `Body::masters`
/// @return ascending
/// @throws chladni::Error for a DOF that is no master, or twice.
std::vector<int> rows_of_masters(std::vector<PetscInt> masters, const std::vector<PetscInt>& held);

/// Some masters are held, or none. The zero-energy motions are those that K does not resist,
/// whatever they are.
class HeldMasters : public Support {
 public:
  HeldMasters() = default;  ///< none
  /// @param masters  `Body::masters`
  /// @param held     some of them, each once
  /// @throws chladni::Error for a DOF that is no master.
  HeldMasters(const std::vector<PetscInt>& masters, std::vector<PetscInt> held);

  std::vector<PetscInt> held() const override { return held_; }
  /// All modes that there are.
  /// @throws chladni::Error when K_r or M_r is not semidefinite.
  SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const override;
  double zero_energy(const ReducedModel& model, const SupportedModes& modes) const override;

 private:
  std::vector<PetscInt> held_;
  std::vector<int> rows_;  ///< of the models, ascending
};

}  // namespace chladni::reduce
