static char help[] =
  "Eigenvalues of the 2-D Laplacian, the first problem of SLEPc's tutorial. Plain SLEPc: this\n"
  "program is neither compiled nor linked against Chladni. Run it with the plugin by\n"
  "  ./laplacian -dll_append libchladni_petsc.so -eps_type blocklanczos -st_type sinvert\n"
  "      -eps_target 0\n"
  "  -n N             points on a side\n"
  "  -generalised     with the (diagonal) mass matrix of the unit square\n"
  "  -massless        every second point of it without mass\n\n";

#include <slepceps.h>

/* -Laplace u on the unit square, u = 0 on its boundary; five points, scaled by h^2. */
static PetscErrorCode create_stiffness(PetscInt n, Mat *K)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n * n, n * n, 5, NULL, 4,
                         NULL, K));
  PetscCall(MatGetOwnershipRange(*K, &first, &last));
  for (PetscInt row = first; row < last; row++) {
    const PetscInt i = row / n, j = row % n;

    PetscCall(MatSetValue(*K, row, row, 4.0, INSERT_VALUES));
    if (i > 0) PetscCall(MatSetValue(*K, row, row - n, -1.0, INSERT_VALUES));
    if (i < n - 1) PetscCall(MatSetValue(*K, row, row + n, -1.0, INSERT_VALUES));
    if (j > 0) PetscCall(MatSetValue(*K, row, row - 1, -1.0, INSERT_VALUES));
    if (j < n - 1) PetscCall(MatSetValue(*K, row, row + 1, -1.0, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*K, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

static PetscErrorCode create_mass(PetscInt n, PetscBool massless, Mat *M)
{
  const PetscReal h = 1.0 / (n + 1);
  PetscInt        first, last;

  PetscFunctionBeginUser;
  PetscCall(
    MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n * n, n * n, 1, NULL, 0, NULL, M));
  PetscCall(MatGetOwnershipRange(*M, &first, &last));
  for (PetscInt row = first; row < last; row++) {
    PetscCall(MatSetValue(*M, row, row, massless && row % 2 ? 0.0 : h * h, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*M, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt  n = 30, n_converged;
  PetscBool generalised = PETSC_FALSE, massless = PETSC_FALSE;
  Mat       K, M = NULL;
  EPS       eps;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, help));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-generalised", &generalised, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-massless", &massless, NULL));
  PetscCall(create_stiffness(n, &K));
  if (generalised) PetscCall(create_mass(n, massless, &M));

  PetscCall(EPSCreate(PETSC_COMM_WORLD, &eps));
  PetscCall(EPSSetOperators(eps, K, M));
  PetscCall(EPSSetProblemType(eps, generalised ? EPS_GHEP : EPS_HEP));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(EPSSolve(eps));

  PetscCall(EPSGetConverged(eps, &n_converged));
  for (PetscInt i = 0; i < n_converged; i++) {
    PetscScalar lambda;
    PetscReal   error;

    PetscCall(EPSGetEigenpair(eps, i, &lambda, NULL, NULL, NULL));
    PetscCall(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%3d %.14e %.2e\n", (int)i, (double)lambda,
                          (double)error));
  }
  PetscCall(EPSDestroy(&eps));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(SlepcFinalize());
  return 0;
}
