#pragma once

#include <vector>

#include "reduce/support.hpp"

namespace chladni::reduce {

/// Combinations of motions that are zero in some rows.
/// @param R     [n x r] linearly independent columns
/// @param rows  ascending
/// @return R Q with orthonormal columns Q
Eigen::MatrixXd at_rest(const Eigen::MatrixXd& R, const std::vector<int>& rows);

/// The numbers of 0 .. n - 1 that are not in `rows`, ascending.
/// @param rows  ascending
std::vector<int> all_but(const std::vector<int>& rows, Eigen::Index n);

/// The rows of some masters in reduced models, where masters ascend by DOF.
/// @param masters  `Body::masters`
/// @param held     global DOFs
/// @return ascending
/// @throws chladni::Error for a DOF that is no master or is given twice.
std::vector<int> rows_of_masters(std::vector<PetscInt> masters, const std::vector<PetscInt>& held);

/// A support that holds some masters, or none. Its zero-energy motions are `ReducedModel::R`,
/// whether rigid or not.
class HeldMasters : public Support {
 public:
  /// Holds no master.
  HeldMasters() = default;
  /// @param masters  `Body::masters`
  /// @param held     global DOFs among them, each once
  /// @throws chladni::Error for a DOF that is no master or is given twice.
  HeldMasters(const std::vector<PetscInt>& masters, std::vector<PetscInt> held);

  std::vector<PetscInt> held() const override { return held_; }
  /// All elastic modes of the model, whatever range is wanted.
  /// @throws chladni::Error when K_r or M_r is not positive semidefinite.
  SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const override;
  double zero_energy(const ReducedModel& model, const SupportedModes& modes) const override;

 private:
  std::vector<PetscInt> held_;
  std::vector<int> rows_;  ///< of the models, ascending
};

}  // namespace chladni::reduce
