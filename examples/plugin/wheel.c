static char help[] =
    "Solves an annular membrane of equal sectors harmonic by harmonic, from the matrices of one\n"
    "sector, and compares the eigenvalues with those of the whole membrane: by an EPS of each\n"
    "harmonic, and by CMS.\n"
    "  -sectors N   of the whole\n"
    "  -n N         elements along the radius; half as many around a sector\n"
    "  -m M         eigenvalues of the whole that are compared\n"
    "  -eps_...     options of the eigensolver, e.g. -eps_type krylovschur\n"
    "  -cms_...     options of the reduction, e.g. -cms_nmodes 40 -cms_view\n\n";

#include <chladni_cms_cyclic.h>
#include <slepceps.h>

/* Bilinear elements in r = 1/2 .. 1, held at r = 1/2, as many around as `around`; the last row of
   points is the first one again where the membrane closes. Row a n + i is the point at angle a,
   radius i + 1. */
static PetscErrorCode create_membrane(PetscInt n, PetscInt around, PetscReal h, PetscBool closes,
                                      Mat* K, Mat* M)
{
  const PetscReal l = 0.5 / n;
  const PetscInt points = around + (closes ? 0 : 1);
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n * points, n * points, 9,
                         NULL, 9, NULL, K));
  PetscCall(MatDuplicate(*K, MAT_DO_NOT_COPY_VALUES, M));
  PetscCall(MatGetOwnershipRange(*K, &first, &last));
  for (PetscInt e = 0; e < n * around; e++) {
    const PetscInt a = e / n, i = e % n; /* between angles a and a + 1, radii i and i + 1 */
    const PetscReal r = 0.5 + (i + 0.5) * l;

    for (PetscInt p = 0; p < 4; p++) {
      for (PetscInt q = 0; q < 4; q++) {
        const PetscInt ip = i + p % 2 - 1, iq = i + q % 2 - 1; /* -1 is held */
        const PetscInt row = (a + p / 2) % points * n + ip, column = (a + q / 2) % points * n + iq;
        const PetscReal m_r = p % 2 == q % 2 ? l / 3.0 : l / 6.0,
                        m_a = p / 2 == q / 2 ? h / 3.0 : h / 6.0;
        const PetscReal k_r = p % 2 == q % 2 ? 1.0 / l : -1.0 / l,
                        k_a = p / 2 == q / 2 ? 1.0 / h : -1.0 / h;

        if (ip < 0 || iq < 0 || row < first || row >= last) continue;
        PetscCall(MatSetValue(*K, row, column, r * k_r * m_a + m_r * k_a / r, ADD_VALUES));
        PetscCall(MatSetValue(*M, row, column, r * m_r * m_a, ADD_VALUES));
      }
    }
  }
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*M, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* The lowest n eigenvalues; -eps_... chooses the solver. */
static PetscErrorCode solve(Mat K, Mat M, PetscInt n, PetscReal lambda[])
{
  EPS eps;
  ST st;
  KSP ksp;
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(EPSCreate(PETSC_COMM_WORLD, &eps));
  PetscCall(EPSSetOperators(eps, K, M));
  PetscCall(EPSSetProblemType(eps, EPS_GHEP));
  PetscCall(EPSSetType(eps, "blocklanczos"));
  PetscCall(EPSSetDimensions(eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTarget(eps, 0.0));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTolerances(eps, 1e-12, PETSC_DEFAULT));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(EPSSolve(eps));
  for (PetscInt i = 0; i < n; i++) PetscCall(EPSGetEigenvalue(eps, i, &lambda[i], NULL));
  PetscCall(EPSDestroy(&eps));
  PetscFunctionReturn(0);
}

/* The distance to the nearest of n ascending values, relative. */
static PetscReal distance(PetscReal lambda, PetscInt n, const PetscReal values[])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < n; i++) least = PetscMin(least, PetscAbsReal(lambda / values[i] - 1.0));
  return least;
}

int main(int argc, char** argv)
{
  PetscInt count = 12, n = 16, m = 30, around, n_found = 0;
  PetscReal whole[100], found[5000];
  Mat K, M, K_whole, M_whole;
  IS low, high, rim;
  CMS cms;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, help));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-sectors", &count, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-m", &m, NULL));
  m = PetscMin(m, 100); /* so many are asked of each harmonic, too */
  count = PetscMin(count, 90);
  around = n / 2;
  PetscCall(CMSRegisterEPS());

  /* 1. One sector with free edges, and the rows that match: a turn takes the first angle to the
   * last. */
  const PetscReal h = 2.0 * PETSC_PI / (count * around);
  const PetscBool here = PetscGlobalRank == 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscCall(create_membrane(n, around, h, PETSC_FALSE, &K, &M));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, here ? n : 0, 0, 1, &low));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, here ? n : 0, around * n, 1, &high));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, here ? around : 0, n - 1, n, &rim));

  /* 2. A CMS of the sectors. A scalar turns with the sector: blocks of one component, no rotation.
   */
  PetscCall(CMSCreate(PETSC_COMM_WORLD, &cms));
  PetscCall(PetscObjectSetName((PetscObject)cms, "wheel"));
  PetscCall(CMSSetOperators(cms, K, M, NULL));
  PetscCall(CMSSetCyclic(cms, count, low, high, 1, NULL));
  PetscCall(CMSSetInterface(cms, rim));
  PetscCall(CMSSetDimensions(cms, 20));
  PetscCall(CMSSetFromOptions(cms));

  /* 3. The whole membrane, for comparison. */
  PetscCall(create_membrane(n, around * count, h, PETSC_TRUE, &K_whole, &M_whole));
  PetscCall(solve(K_whole, M_whole, m, whole));

  /* 4. Each harmonic: its matrices in an EPS, and reduced. Where it has two phases, lambda is
   * double. */
  PetscCall(
      PetscPrintf(PETSC_COMM_WORLD,
                  "harmonic   lambda         of whole     split        CMS          eta^2\n"));
  for (PetscInt order = 0; order <= count / 2; order++) {
    const PetscReal *f, *eta2;
    PetscReal lambda[100];
    PetscInt n_modes;
    Mat K_n, M_n;

    PetscCall(CMSSetHarmonic(cms, order));
    PetscCall(CMSGetHarmonicOperators(cms, &K_n, &M_n, NULL));
    PetscCall(solve(K_n, M_n, m, lambda));
    PetscCall(CMSSolve(cms));
    PetscCall(CMSGetFrequencies(cms, &n_modes, &f));
    PetscCall(CMSGetErrors(cms, NULL, &eta2));
    for (PetscInt i = 0; i < m; i++)
      if (lambda[i] < whole[m - 1] * (1.0 - 1e-6)) found[n_found++] = lambda[i];
    PetscCall(
        PetscPrintf(PETSC_COMM_WORLD, "%4d %16.9f %12.2e %12.2e %12.2e %12.2e\n", (int)order,
                    (double)lambda[0], (double)distance(lambda[0], m, whole),
                    order == 0 || 2 * order == count ? 0.0 : (double)(lambda[1] / lambda[0] - 1.0),
                    n_modes > 0 ? (double)(PetscSqr(2.0 * PETSC_PI * f[0]) / lambda[0] - 1.0) : 0.0,
                    n_modes > 0 ? (double)eta2[0] : 0.0));
  }

  /* 5. Together they are the whole. */
  PetscReal worst = 0.0;
  PetscInt below = 0;

  for (PetscInt i = 0; i < m; i++) below += whole[i] < whole[m - 1] * (1.0 - 1e-6) ? 1 : 0;
  PetscCall(PetscSortReal(n_found, found));
  for (PetscInt i = 0; i < PetscMin(below, n_found); i++)
    worst = PetscMax(worst, PetscAbsReal(found[i] / whole[i] - 1.0));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "%d of %d eigenvalues of the whole, largest difference %.1e\n",
                        (int)n_found, (int)below, (double)worst));

  PetscCall(CMSDestroy(&cms));
  PetscCall(ISDestroy(&low));
  PetscCall(ISDestroy(&high));
  PetscCall(ISDestroy(&rim));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(MatDestroy(&K_whole));
  PetscCall(MatDestroy(&M_whole));
  PetscCall(SlepcFinalize());
  return 0;
}
