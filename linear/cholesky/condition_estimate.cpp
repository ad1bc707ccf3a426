#include "linear/cholesky/condition_estimate.hpp"

namespace chladni::linear {

namespace {

/// A^-1 x.
petsc::Vector solved(const Factorization& A, Vec x)
{
  petsc::Vector y;
  petsc::check(VecDuplicate(x, y.put()));
  petsc::check(MatSolve(A.factor(), x, y));
  return y;
}

/// x_i <- sign(x_i), of zero 1.
void take_signs(Vec x)
{
  PetscInt n = 0;
  PetscScalar* values = nullptr;
  petsc::check(VecGetLocalSize(x, &n));
  petsc::check(VecGetArray(x, &values));
  for (PetscInt i = 0; i < n; ++i) values[i] = values[i] < 0.0 ? -1.0 : 1.0;
  petsc::check(VecRestoreArray(x, &values));
}

/// |A^-1|_1 of a symmetric A: climbs to a unit vector e_j whose |A^-1 e_j|_1 is a local maximum.
double inverse_norm(const Factorization& A)
{
  constexpr int most_steps = 3;
  petsc::Vector x;
  petsc::check(MatCreateVecs(A.matrix(), x.put(), nullptr));
  PetscInt n = 0;
  petsc::check(VecGetSize(x, &n));
  petsc::check(VecSet(x, 1.0 / n));
  double norm = 0.0;
  for (int step = 0; step < most_steps; ++step) {
    petsc::Vector y = solved(A, x);
    double now = 0.0;
    petsc::check(VecNorm(y, NORM_1, &now));
    if (now <= norm) break;
    norm = now;
    take_signs(y);
    const petsc::Vector z = solved(A, y);  // gradient; A is symmetric
    petsc::check(VecAbs(z));
    PetscInt steepest = 0;
    double largest = 0.0;
    petsc::check(VecMax(z, &steepest, &largest));
    petsc::check(VecSet(x, 0.0));
    if (petsc::rank(petsc::communicator(x)) == 0)
      petsc::check(VecSetValue(x, steepest, 1.0, INSERT_VALUES));
    petsc::check(VecAssemblyBegin(x));
    petsc::check(VecAssemblyEnd(x));
  }
  return norm;
}

}  // namespace

double condition_estimate(const Factorization& A)
{
  double norm = 0.0;
  petsc::check(MatNorm(A.matrix(), NORM_1, &norm));
  return norm * inverse_norm(A);
}

}  // namespace chladni::linear
