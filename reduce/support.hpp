#pragma once

#include <limits>
#include <vector>

#include "reduce/error_estimates.hpp"

namespace chladni::reduce {

/// A range of the spectrum: all eigenvalues up to lambda_max and one more, at most `most`.
struct SpectrumRange {
  double lambda_max = std::numeric_limits<double>::infinity();  ///< rad^2/s^2
  PetscInt most = std::numeric_limits<PetscInt>::max();
};

/// Elastic modes of a reduced model under a support.
struct SupportedModes {
  ReducedPairs pairs{.X = {}, .lambda = {}};  ///< ascending; those wanted, or more
  bool are_all = false;                       ///< true when the model has no other
  int n_zero = 0;       ///< number of zero-energy motions that the support leaves
  int n_free_zero = 0;  ///< number of zero-energy motions without a support
};

/// The support of the body whose frequencies a reduction certifies: it holds some of the masters.
class Support {
 public:
  Support() = default;
  virtual ~Support() = default;
  Support(const Support&) = delete;
  Support& operator=(const Support&) = delete;

  /// The held masters as global DOFs, the same list on every rank.
  virtual std::vector<PetscInt> held() const = 0;
  /// The elastic modes of a range. Called on the first rank only, which sends them to the others:
  /// round-off could let ranks differ.
  /// @throws chladni::Error when the model is no body with this support.
  virtual SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const = 0;
  /// The largest energy of the zero-energy motions without a support over the first elastic lambda;
  /// 0 is perfect. Called on the first rank only.
  /// @param modes  the result of `modes` for this model
  virtual double zero_energy(const ReducedModel& model, const SupportedModes& modes) const = 0;
};

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
