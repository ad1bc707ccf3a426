static char help[] =
  "Reduces somebody's stiffness and mass matrix from MatrixMarket files.\n"
  "  -K FILE -M FILE     real, coordinate, symmetric or general\n"
  "  -C FILE             damping, optional\n"
  "  -masters 3,7,12     rows to keep, counted from 1 as in the files\n"
  "  -cms_...            options of the reduction, e.g. -cms_view hdf5:body.reduced.h5\n\n";

#include <chladni_cms.h>
#include <slepcsys.h>
#include <string.h>

typedef struct {
  PetscInt  n_rows, n_columns, n_entries;
  PetscBool symmetric;
} Banner;

/* The banner, comments and the line of sizes. */
static PetscErrorCode read_banner(FILE *file, const char name[], Banner *banner)
{
  char line[1024], format[32], field[32], symmetry[32];
  long n_rows, n_columns, n_entries;

  PetscFunctionBeginUser;
  PetscCheck(fgets(line, sizeof line, file), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s is empty", name);
  PetscCheck(sscanf(line, "%%%%MatrixMarket matrix %31s %31s %31s", format, field, symmetry) == 3,
             PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s does not begin with a %%%%MatrixMarket banner", name);
  PetscCheck(strcmp(format, "coordinate") == 0 && (strcmp(field, "real") == 0 || strcmp(field, "integer") == 0),
             PETSC_COMM_SELF, PETSC_ERR_SUP, "%s is %s %s; give coordinate real", name, format, field);
  banner->symmetric = strcmp(symmetry, "symmetric") == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(banner->symmetric || strcmp(symmetry, "general") == 0, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "%s is %s; give symmetric or general", name, symmetry);
  do {
    PetscCheck(fgets(line, sizeof line, file), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s has no line of sizes", name);
  } while (line[0] == '%');
  PetscCheck(sscanf(line, "%ld %ld %ld", &n_rows, &n_columns, &n_entries) == 3, PETSC_COMM_SELF,
             PETSC_ERR_FILE_UNEXPECTED, "%s: \"%s\" is no line of sizes", name, line);
  PetscCall(PetscIntCast(n_rows, &banner->n_rows));
  PetscCall(PetscIntCast(n_columns, &banner->n_columns));
  PetscCall(PetscIntCast(n_entries, &banner->n_entries));
  PetscFunctionReturn(0);
}

/* Entries as three arrays; the mirrored ones of a symmetric file included. */
static PetscErrorCode read_entries(FILE *file, const char name[], const Banner *banner, PetscInt *n,
                                   PetscInt rows[], PetscInt columns[], PetscScalar values[])
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt k = 0; k < banner->n_entries; k++) {
    long   i, j;
    double value;

    PetscCheck(fscanf(file, "%ld %ld %lf", &i, &j, &value) == 3, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "%s ends after %d of %d entries", name, (int)k, (int)banner->n_entries);
    PetscCheck(i >= 1 && i <= banner->n_rows && j >= 1 && j <= banner->n_columns, PETSC_COMM_SELF,
               PETSC_ERR_FILE_UNEXPECTED, "%s: entry (%ld, %ld) is outside the matrix", name, i, j);
    rows[*n]       = (PetscInt)(i - 1);
    columns[*n]    = (PetscInt)(j - 1);
    values[(*n)++] = value;
    if (!banner->symmetric || i == j) continue;
    rows[*n]       = (PetscInt)(j - 1);
    columns[*n]    = (PetscInt)(i - 1);
    values[(*n)++] = value;
  }
  PetscFunctionReturn(0);
}

/* Read on the first rank, distributed by PETSc. */
static PetscErrorCode load_matrix(const char name[], Mat *A)
{
  Banner       banner = {0, 0, 0, PETSC_FALSE};
  PetscInt     n = 0, *rows = NULL, *columns = NULL, sizes[2];
  PetscScalar *values = NULL;
  FILE        *file   = NULL;
  PetscMPIInt  rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (rank == 0) {
    file = fopen(name, "r");
    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be read", name);
    PetscCall(read_banner(file, name, &banner));
    PetscCall(PetscMalloc3(2 * banner.n_entries, &rows, 2 * banner.n_entries, &columns, 2 * banner.n_entries, &values));
    PetscCall(read_entries(file, name, &banner, &n, rows, columns, values));
    fclose(file);
  }
  sizes[0] = banner.n_rows;
  sizes[1] = banner.n_columns;
  PetscCallMPI(MPI_Bcast(sizes, 2, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCall(MatCreate(PETSC_COMM_WORLD, A));
  PetscCall(MatSetSizes(*A, PETSC_DECIDE, PETSC_DECIDE, sizes[0], sizes[1]));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetPreallocationCOO(*A, n, rows, columns));
  PetscCall(MatSetValuesCOO(*A, values, ADD_VALUES));
  PetscCall(PetscFree3(rows, columns, values));
  PetscFunctionReturn(0);
}

static PetscErrorCode load_option(const char option[], PetscBool required, Mat *A)
{
  char      name[PETSC_MAX_PATH_LEN];
  PetscBool given;

  PetscFunctionBeginUser;
  *A = NULL;
  PetscCall(PetscOptionsGetString(NULL, NULL, option, name, sizeof name, &given));
  PetscCheck(given || !required, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT, "Give %s FILE", option);
  if (given) PetscCall(load_matrix(name, A));
  PetscFunctionReturn(0);
}

/* All of them from the first rank: an interface may be given on any. */
static PetscErrorCode masters_from_options(IS *masters)
{
  PetscInt    indices[4096], n = 4096;
  PetscBool   given;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-masters", indices, &n, &given));
  PetscCheck(given, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT, "Give -masters 3,7,12: the rows to keep, from 1");
  for (PetscInt i = 0; i < n; i++) indices[i]--;
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, rank == 0 ? n : 0, indices, PETSC_COPY_VALUES, masters));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Mat              K, M, C;
  IS               masters;
  CMS              cms;
  PetscInt         n, n_errors;
  const PetscReal *f, *eta2;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, help));
  PetscCall(load_option("-K", PETSC_TRUE, &K));
  PetscCall(load_option("-M", PETSC_TRUE, &M));
  PetscCall(load_option("-C", PETSC_FALSE, &C));
  PetscCall(masters_from_options(&masters));

  PetscCall(CMSCreate(PETSC_COMM_WORLD, &cms));
  PetscCall(CMSSetOperators(cms, K, M, C));
  PetscCall(CMSSetInterface(cms, masters));
  PetscCall(CMSSetFromOptions(cms));
  PetscCall(CMSSolve(cms));

  PetscCall(CMSGetFrequencies(cms, &n, &f));
  PetscCall(CMSGetErrors(cms, &n_errors, &eta2));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%4d %.12e Hz", (int)i + 1, (double)f[i]));
    if (i < n_errors) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  eta^2 %.2e", (double)eta2[i]));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n"));
  }
  PetscCall(CMSDestroy(&cms));
  PetscCall(ISDestroy(&masters));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(MatDestroy(&C));
  PetscCall(SlepcFinalize());
  return 0;
}
