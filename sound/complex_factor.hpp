#pragma once

#include <zmumps_c.h>

#include <Eigen/SparseCore>
#include <complex>
#include <vector>

namespace chladni::sound {

/// LDL^T of a complex symmetric matrix by MUMPS on this process alone, eliminated in an order by
/// METIS.
/// @note MPI must be running.
class ComplexFactor {
 public:
  using Sparse = Eigen::SparseMatrix<std::complex<double>>;

  /// @param lower  the lower triangle
  /// @throws chladni::Error when the factorisation fails.
  explicit ComplexFactor(const Sparse& lower);
  ~ComplexFactor();
  ComplexFactor(const ComplexFactor&) = delete;
  ComplexFactor& operator=(const ComplexFactor&) = delete;

  Eigen::MatrixXcd solve(Eigen::MatrixXcd right_hand_sides);
  double memory_MiB() const { return mumps_.infog[21]; }  ///< INFOG(22)

 private:
  void call(int job, const char* what);

  ZMUMPS_STRUC_C mumps_{};
  std::vector<int> rows_, columns_, order_;
  std::vector<std::complex<double>> values_;
};

}  // namespace chladni::sound
