#pragma once

#include <chladni_cms.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "pencils.hpp"

/// The strangers through the C interface of CMS and through EPS.
namespace chladni::strangers {

/// Rows of a matrix as arrays.
struct Rows {
  std::vector<PetscInt> first, column;
  std::vector<double> value;
};

/// K and M of a communicator; every rank owns rows as PETSc likes.
struct Operators {
  Rows of_K{}, of_M{};  ///< that the matrices refer to
  petsc::Matrix K{}, M{};
};
Operators operators(const Pencil& pencil, MPI_Comm comm);
/// On one process, each entry in two parts and every row in another order: what csr matrices of
/// other programs may look like.
Operators shuffled_operators(const Pencil& pencil);

/// One way to reduce; the first that is set counts.
struct Reduction {
  CMSType type = CMSCRAIGBAMPTON;
  int modes = 0;
  double cutoff_Hz = 0.0;
  double tolerance = 0.0, up_to_Hz = 0.0;
  bool is_shuffled = false;  ///< `shuffled_operators`, where there is one process
};

/// What CMS hands out, the same on every rank.
struct Answer {
  PetscErrorCode code = 0;
  std::string message{};
  int n_masters = 0, n_modes = 0;
  Eigen::MatrixXd K_r{}, M_r{}, T{};
  std::vector<double> lambda{}, eta2{}, rounding{}, bounds{};
  CMSQuality quality{};

  /// Relative, what the certificate says that rounding does to frequency i.
  double rounding_of(std::size_t i) const { return i < rounding.size() ? rounding[i] : 0.0; }
};
/// Of an object that has solved, or failed with this code.
Answer answer_of(CMS cms, PetscErrorCode code);
/// The method and the number of modes.
PetscErrorCode set(CMS cms, const Reduction& how);
Answer reduce(const Pencil& pencil, const Reduction& how, MPI_Comm comm);

/// Eigenpairs of EPS type blocklanczos with shift-and-invert.
struct Eigenpairs {
  PetscErrorCode code = 0;
  std::string message{};
  std::vector<double> lambda{};
  std::vector<double> residual{};  ///< |K x - lambda M x| / (|K| + |lambda| |M|) |x|
};
Eigenpairs eigenpairs(const Pencil& pencil, int n, double target, MPI_Comm comm);

}  // namespace chladni::strangers
