static char help[] =
  "Reduces a membrane to the points on one of its edges and compares the frequencies of the reduced\n"
  "model with those of the full one.\n"
  "  -n N         points on a side\n"
  "  -cms_...     options of the reduction, e.g. -cms_nmodes 30 -cms_view -cms_monitor\n\n";

#include <chladni_cms.h>
#include <slepceps.h>

/* Bilinear finite elements of a unit square, free on the edge x = 0 and held on the others.
   The points of column 0 are rows 0 .. n - 1: they will be the masters. */
static PetscErrorCode create_membrane(PetscInt n, Mat *K, Mat *M)
{
  static const PetscReal k_e[4][4] = {{4, -1, -2, -1}, {-1, 4, -1, -2}, {-2, -1, 4, -1}, {-1, -2, -1, 4}};
  static const PetscReal m_e[4][4] = {{4, 2, 1, 2}, {2, 4, 2, 1}, {1, 2, 4, 2}, {2, 1, 2, 4}};
  const PetscReal        h = 1.0 / n;
  PetscInt               first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n * n, n * n, 9, NULL, 8, NULL, K));
  PetscCall(MatDuplicate(*K, MAT_DO_NOT_COPY_VALUES, M));
  PetscCall(MatGetOwnershipRange(*K, &first, &last));
  /* Row a n + b is the point (a h, (b + 1) h); elements beyond the held edges lose their points. */
  for (PetscInt row = first; row < last; row++) {
    const PetscInt a = row / n, b = row % n;

    for (PetscInt e = 0; e < 4; e++) { /* the four elements around the point */
      const PetscInt a0 = a - (e == 0 || e == 3 ? 0 : 1), b0 = b - (e < 2 ? 0 : 1);

      if (a0 < 0) continue; /* left of the free edge */
      for (PetscInt j = 0; j < 4; j++) {
        const PetscInt aj = a0 + (j == 1 || j == 2), bj = b0 + (j >= 2);

        if (aj >= n || bj < 0 || bj >= n) continue; /* held */
        PetscCall(MatSetValue(*K, row, aj * n + bj, k_e[e][j] / 6.0, ADD_VALUES));
        PetscCall(MatSetValue(*M, row, aj * n + bj, m_e[e][j] * h * h / 36.0, ADD_VALUES));
      }
    }
  }
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*M, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* The lowest n eigenvalues of the full problem. */
static PetscErrorCode solve_full(Mat K, Mat M, PetscInt n, PetscReal lambda[])
{
  EPS eps;
  ST  st;

  PetscFunctionBeginUser;
  PetscCall(EPSCreate(PETSC_COMM_WORLD, &eps));
  PetscCall(EPSSetOptionsPrefix(eps, "full_"));
  PetscCall(EPSSetOperators(eps, K, M));
  PetscCall(EPSSetProblemType(eps, EPS_GHEP));
  PetscCall(EPSSetDimensions(eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTarget(eps, 0.0));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTolerances(eps, 1e-12, PETSC_DEFAULT));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(EPSSolve(eps));
  for (PetscInt i = 0; i < n; i++) PetscCall(EPSGetEigenvalue(eps, i, &lambda[i], NULL));
  PetscCall(EPSDestroy(&eps));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt         n = 24, n_modes, n_errors, first, last;
  const PetscReal *f, *eta2;
  PetscReal        lambda[8];
  Mat              K, M;
  IS               edge;
  CMS              cms;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, help));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));

  /* 1. Any two symmetric matrices, and the rows that the reduced model is to keep. */
  PetscCall(create_membrane(n, &K, &M));
  PetscCall(MatGetOwnershipRange(K, &first, &last));
  first = PetscMin(first, n);
  last  = PetscMin(last, n);
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, last - first, first, 1, &edge));

  /* 2. The reduction. */
  PetscCall(CMSCreate(PETSC_COMM_WORLD, &cms));
  PetscCall(PetscObjectSetName((PetscObject)cms, "membrane"));
  PetscCall(CMSSetOperators(cms, K, M, NULL));
  PetscCall(CMSSetInterface(cms, edge));
  PetscCall(CMSSetFromOptions(cms));
  PetscCall(CMSSolve(cms));

  /* 3. Its frequencies with their estimated errors, beside those of the full model. */
  PetscCall(CMSGetFrequencies(cms, &n_modes, &f));
  PetscCall(CMSGetErrors(cms, &n_errors, &eta2));
  n_modes = PetscMin(n_modes, 8);
  PetscCall(solve_full(K, M, n_modes, lambda));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "mode   lambda         true error   eta^2\n"));
  for (PetscInt i = 0; i < n_modes; i++) {
    const PetscReal reduced = PetscSqr(2.0 * PETSC_PI * f[i]);

    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%4d %12.6f %12.3e", (int)i + 1, (double)reduced,
                          (double)(reduced / lambda[i] - 1.0)));
    if (i < n_errors) PetscCall(PetscPrintf(PETSC_COMM_WORLD, " %12.3e\n", (double)eta2[i]));
    else PetscCall(PetscPrintf(PETSC_COMM_WORLD, "            -\n"));
  }
  PetscCall(CMSDestroy(&cms));
  PetscCall(ISDestroy(&edge));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(SlepcFinalize());
  return 0;
}
