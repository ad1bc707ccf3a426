#include "reduce/symmetric_eigen.hpp"

// LAPACK's symbol: PETSc declares dsyev only, which is several times slower with vectors.
extern "C" void dsyevd_(const char* jobz,
                        const char* uplo,  // NOLINT(readability-identifier-naming)
                        const int* n, double* a, const int* lda, double* w, double* work,
                        const int* lwork, int* iwork, const int* liwork, int* info);

namespace chladni::reduce {

SymmetricEigen symmetric_eigen(SmallMatrix A)
{
  const int n = A.n_rows;
  SymmetricEigen eigen{.values = std::vector<double>(n), .vectors = {0, 0}};
  if (n == 0) return eigen;
  int info = 0, work_size = -1, integer_size = -1, integers_needed = 0;
  double work_needed = 0.0;
  dsyevd_("V", "U", &n, A.values.data(), &n, eigen.values.data(), &work_needed, &work_size,
          &integers_needed, &integer_size, &info);
  work_size = static_cast<int>(work_needed);
  integer_size = integers_needed;
  std::vector<double> work(work_size);
  std::vector<int> integers(integer_size);
  dsyevd_("V", "U", &n, A.values.data(), &n, eigen.values.data(), work.data(), &work_size,
          integers.data(), &integer_size, &info);
  if (info != 0) throw Error(fmt::format("symmetric_eigen: LAPACK dsyevd failed with {}", info));
  eigen.vectors = std::move(A);
  return eigen;
}

}  // namespace chladni::reduce
