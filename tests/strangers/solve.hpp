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

/// K and M of a communicator; every rank owns rows as PETSc likes.
struct Operators {
  petsc::Matrix K, M;
};
Operators operators(const Pencil& pencil, MPI_Comm comm);

/// One way to reduce; the first that is set counts.
struct Reduction {
  CMSType type = CMSCRAIGBAMPTON;
  int modes = 0;
  double cutoff_Hz = 0.0;
  double tolerance = 0.0, up_to_Hz = 0.0;
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
