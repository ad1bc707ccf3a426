/* CMS: component mode synthesis (Guyan, Craig-Bampton and others) of any two symmetric PETSc
   matrices, as a solver object in the style of PETSc and SLEPc. Plain C; docs/how-to/plugin.md is
   the guide.

     CMSCreate(comm, &cms);
     CMSSetOperators(cms, K, M, NULL);
     CMSSetInterface(cms, masters);
     CMSSetFromOptions(cms);
     CMSSolve(cms);
     CMSGetReducedOperators(cms, &Kr, &Mr, NULL);
     CMSDestroy(&cms);

   Every function returns a PETSc error code, the same on all ranks. It is collective on the
   communicator of the object unless it only reads or sets a number. */
#ifndef CHLADNI_CMS_H
#define CHLADNI_CMS_H

#include <petscmat.h>

typedef struct _p_CMS* CMS;
typedef const char* CMSType;

#define CMSGUYAN "guyan"                /* masters only: static condensation */
#define CMSCRAIGBAMPTON "craig-bampton" /* masters and fixed-interface modes; the default */
#define CMSMIXED "mixed-interface" /* modes with the masters of CMSSetHeld held, the others free \
                                    */
#define CMSRUBIN "rubin" /* modes of the free body and residual flexibility, consistent mass */
#define CMSAUTO "auto"   /* Craig-Bampton or mixed interface, whichever costs less for a tolerance \
                          */

/* The number of eigenvalues of the full model in a range, and how many of them were found. */
typedef struct {
  PetscReal upto;    /* f in Hz: the range is lambda < (2 pi f)^2; 0 when nothing was counted */
  PetscInt expected; /* in the full model, by the pivots of K - (2 pi f)^2 M (Sylvester) */
  PetscInt found;    /* in the reduced model */
  PetscInt missing;  /* expected - found */
} CMSCount;

/* The quality of the reduction, besides the errors of single frequencies. */
typedef struct {
  PetscInt n_zero;          /* zero-energy (rigid-body) modes of the reduced model */
  PetscReal rigid_residual; /* their largest eigenvalue over the first elastic one; 0 is perfect */
  PetscReal condition;      /* estimate of |K_ss|_1 |K_ss^-1|_1 */
  CMSCount modes;           /* of the fixed-interface problem, up to the last mode kept */
  CMSCount model;           /* of the free model, up to the last mode with an error estimate */
  CMSCount complete;        /* the largest counted range in which none is missing */
} CMSQuality;

/* phase: "factorization", "constraint modes", ...; seconds: its wall time on this rank. */
typedef PetscErrorCode (*CMSMonitorFunction)(CMS cms, const char phase[], PetscReal seconds,
                                             void* ctx);

/* fraction: how much of the running phase is done, 0 to 1. */
typedef PetscErrorCode (*CMSProgressFunction)(CMS cms, const char phase[], PetscReal fraction,
                                              void* ctx);

PETSC_EXTERN PetscClassId CMS_CLASSID;

/* Registers class, log events and stages; CMSCreate and -dll_append call it. */
PETSC_EXTERN PetscErrorCode CMSInitializePackage(void);
/* Registers the SLEPc solver type "blocklanczos"; -dll_append calls it. */
PETSC_EXTERN PetscErrorCode CMSRegisterEPS(void);

PETSC_EXTERN PetscErrorCode CMSCreate(MPI_Comm comm, CMS* cms);
PETSC_EXTERN PetscErrorCode CMSDestroy(CMS* cms);
/* Deletes results and factor; keeps operators, interface and settings. */
PETSC_EXTERN PetscErrorCode CMSReset(CMS cms);

/* Sets the operators, which have one size and layout: symmetric K with K_ss positive definite,
   symmetric positive semidefinite M, and C or NULL. C may be damping (symmetric), gyroscopic
   (skew-symmetric) or their sum. Any matrix type that converts to AIJ will do. The object takes
   references; call this again after the values have changed. */
PETSC_EXTERN PetscErrorCode CMSSetOperators(CMS cms, Mat K, Mat M, Mat C);
PETSC_EXTERN PetscErrorCode CMSGetOperators(CMS cms, Mat* K, Mat* M, Mat* C);
/* Sets the masters: global indices, each once, on any rank. The reduced rows keep their order. */
PETSC_EXTERN PetscErrorCode CMSSetInterface(CMS cms, IS masters);
PETSC_EXTERN PetscErrorCode CMSGetInterface(CMS cms, IS* masters);
/* Sets, for the file only, the node, component (0..5 = x y z rx ry rz) and position (x y z in m) of
   each master, in the order of this rank's part of the interface. Without this call the block size
   b <= 6 of K defines nodes of b components at the origin. */
PETSC_EXTERN PetscErrorCode CMSSetInterfaceGeometry(CMS cms, PetscInt n, const PetscInt nodes[],
                                                    const PetscInt components[],
                                                    const PetscReal positions[]);
/* Sets the support: the masters that will be held, global indices, each once, on any rank; NULL
   (default): none. Frequencies, errors, counts and mixed-interface modes are those of the supported
   body. All masters remain rows of the reduced model, so other supports remain possible. */
PETSC_EXTERN PetscErrorCode CMSSetHeld(CMS cms, IS held);
/* Sets the rows of CMSGetTransformation, global indices; NULL (default): all, laid out as K. */
PETSC_EXTERN PetscErrorCode CMSSetOutput(CMS cms, IS rows);

/* Sets the method. -cms_type guyan|craig-bampton|mixed-interface|rubin|auto */
PETSC_EXTERN PetscErrorCode CMSSetType(CMS cms, CMSType type);
PETSC_EXTERN PetscErrorCode CMSGetType(CMS cms, CMSType* type);
/* Set the number of modes, directly, by a cut-off or by a tolerance; the last of the three calls
   counts. -cms_nmodes N | -cms_cutoff F | -cms_tol T -cms_tol_upto F; F in Hz: lambda = (2 pi F)^2.
   A tolerance keeps the estimated relative error of all frequencies up to F below T; the mixed
   interface takes all modes up to F. CMSAUTO needs a tolerance; Guyan and Rubin cannot keep
   one and are refused with it. */
PETSC_EXTERN PetscErrorCode CMSSetDimensions(CMS cms, PetscInt nmodes);
PETSC_EXTERN PetscErrorCode CMSSetCutoff(CMS cms, PetscReal f);
PETSC_EXTERN PetscErrorCode CMSSetTolerance(CMS cms, PetscReal tol, PetscReal upto);
/* Returns the numbers of masters (valid after CMSSetUp) and of modes (after CMSSolve). */
PETSC_EXTERN PetscErrorCode CMSGetDimensions(CMS cms, PetscInt* nmasters, PetscInt* nmodes);
/* Sets whether CMSSolve counts eigenvalues by Sylvester's law, with two to four more
   factorisations; asked for after a solution, CMSSolve solves again. -cms_sylvester */
PETSC_EXTERN PetscErrorCode CMSSetSylvester(CMS cms, PetscBool count);

PETSC_EXTERN PetscErrorCode CMSSetOptionsPrefix(CMS cms, const char prefix[]);
PETSC_EXTERN PetscErrorCode CMSAppendOptionsPrefix(CMS cms, const char prefix[]);
PETSC_EXTERN PetscErrorCode CMSGetOptionsPrefix(CMS cms, const char* prefix[]);
PETSC_EXTERN PetscErrorCode CMSSetFromOptions(CMS cms);
/* Sets a function to be called at the end of each phase. It may not change the object: calls that
   would are refused with PETSC_ERR_ORDER. -cms_monitor prints the phases. */
PETSC_EXTERN PetscErrorCode CMSMonitorSet(CMS cms, CMSMonitorFunction monitor, void* ctx);
/* Sets a function that each rank calls by itself during a long phase. An error that it returns
   stops the solution: at once on one rank, at the end of the phase on several. */
PETSC_EXTERN PetscErrorCode CMSProgressSet(CMS cms, CMSProgressFunction progress, void* ctx);

/* Checks the input, divides masters from slaves and factors K_ss. */
PETSC_EXTERN PetscErrorCode CMSSetUp(CMS cms);
/* Reduces and estimates the errors. Calls CMSSetUp if needed; obeys -cms_view. */
PETSC_EXTERN PetscErrorCode CMSSolve(CMS cms);

/* Returns K_r, M_r and C_r: dense, distributed, owned by the object. C is NULL if none was set.
   Pass NULL for what is not wanted. */
PETSC_EXTERN PetscErrorCode CMSGetReducedOperators(CMS cms, Mat* K, Mat* M, Mat* C);
/* Returns T with u = T (u_m, q), K_r = T^T K T. Dense, computed at the first call, owned by the
   object. */
PETSC_EXTERN PetscErrorCode CMSGetTransformation(CMS cms, Mat* T);
/* Returns the frequencies in Hz, ascending, of the elastic modes of the reduced model under the
   support of CMSSetHeld, up to the last fixed- or mixed-interface mode, at most 100; with Guyan the
   lowest 20; with a tolerance all up to F. The array is owned by the object. */
PETSC_EXTERN PetscErrorCode CMSGetFrequencies(CMS cms, PetscInt* n, const PetscReal* f[]);
/* Returns eta^2 of the same modes, the estimated relative errors of lambda; those of f are half of
   it. */
PETSC_EXTERN PetscErrorCode CMSGetErrors(CMS cms, PetscInt* n, const PetscReal* eta2[]);
/* Returns the relative errors of lambda of the same modes by rounding, which eta^2 omits. */
PETSC_EXTERN PetscErrorCode CMSGetRounding(CMS cms, PetscInt* n, const PetscReal* rounding[]);
/* Returns upper bounds of the relative errors of lambda (Temple, Lehmann) of the modes below the
   frequency up to which -cms_sylvester found none missing; n = 0 without a count. They include the
   errors by rounding to first order. */
PETSC_EXTERN PetscErrorCode CMSGetErrorBounds(CMS cms, PetscInt* n, const PetscReal* bounds[]);
/* Returns counts, condition number and rigid-body residual. */
PETSC_EXTERN PetscErrorCode CMSGetQuality(CMS cms, CMSQuality* quality);

/* Prints a summary (ascii) or writes the reduced file of docs/reference/file_formats.md (hdf5).
   -cms_view [ascii|hdf5:FILE] */
PETSC_EXTERN PetscErrorCode CMSView(CMS cms, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode CMSViewFromOptions(CMS cms, PetscObject prefixed, const char name[]);
/* Writes the reduced file, completely or not at all: an interrupted run keeps an older file. */
PETSC_EXTERN PetscErrorCode CMSWrite(CMS cms, const char filename[]);

#endif
