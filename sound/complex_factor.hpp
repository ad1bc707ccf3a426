#pragma once

#include <zmumps_c.h>

#include <Eigen/SparseCore>
#include <complex>
#include <vector>

namespace chladni::sound {

/// LDL^T factor of a complex symmetric matrix, computed by MUMPS on this process alone with an
/// ordering by METIS.
/// @note MPI must be initialised.
class ComplexFactor {
 public:
  using Sparse = Eigen::SparseMatrix<std::complex<double>>;

  /// Factorises a matrix.
  /// @param lower  its lower triangle
  /// @throws chladni::Error when the factorisation fails.
  explicit ComplexFactor(const Sparse& lower);
  ~ComplexFactor();
  ComplexFactor(const ComplexFactor&) = delete;
  ComplexFactor& operator=(const ComplexFactor&) = delete;

  /// Solves for any number of right-hand sides, one per column.
  /// @throws chladni::Error when MUMPS fails.
  Eigen::MatrixXcd solve(Eigen::MatrixXcd right_hand_sides);
  double memory_MiB() const { return mumps_.infog[21]; }  ///< INFOG(22)

 private:
  void call(int job, const char* what);

  ZMUMPS_STRUC_C mumps_{};
  std::vector<int> rows_, columns_, order_;
  std::vector<std::complex<double>> values_;
};

}  // namespace chladni::sound
