/* CMS: component mode synthesis (Guyan, Craig-Bampton) of any two symmetric PETSc matrices, as one
   more solver object in the grammar of PETSc and SLEPc. Plain C; docs/how-to/plugin.md is the guide.

     CMSCreate(comm, &cms);
     CMSSetOperators(cms, K, M, NULL);
     CMSSetInterface(cms, masters);
     CMSSetFromOptions(cms);
     CMSSolve(cms);
     CMSGetReducedOperators(cms, &Kr, &Mr, NULL);
     CMSDestroy(&cms);

   Every function returns a PETSc error code, on all ranks alike, and is collective on the
   communicator of the object unless it only reads or sets a number. */
#ifndef CHLADNI_CMS_H
#define CHLADNI_CMS_H

#include <petscmat.h>

typedef struct _p_CMS* CMS;
typedef const char* CMSType;

#define CMSGUYAN "guyan"                /* masters only: static condensation */
#define CMSCRAIGBAMPTON "craig-bampton" /* masters and fixed-interface modes; the default */
#define CMSMIXED "mixed-interface" /* modes with the rows of CMSSetHeld held, the other masters free */
#define CMSRUBIN "rubin"     /* modes of the free body and residual flexibility, consistent mass */
#define CMSMACNEAL "macneal" /* the same with the mass of the modes alone; no error estimates */
#define CMSAUTO "auto" /* of Craig-Bampton and mixed interface what costs least for a tolerance */

/* How the modes found compare with the number of eigenvalues that the full model must have. */
typedef struct {
  PetscReal upto;    /* f in Hz; counted are lambda < (2 pi f)^2; 0 when nothing was counted */
  PetscInt expected; /* from the signs of the pivots of K - (2 pi f)^2 M (Sylvester) */
  PetscInt found;    /* in the reduced model */
  PetscInt missing;  /* expected - found */
} CMSCount;

/* Figures of merit of the reduction, besides the errors of the single frequencies. */
typedef struct {
  PetscInt n_zero;          /* zero-energy (rigid-body) modes of the reduced model */
  PetscReal rigid_residual; /* their largest eigenvalue over the first elastic one; 0 is perfect */
  PetscReal condition;      /* estimate of |K_ss|_1 |K_ss^-1|_1 */
  CMSCount modes;           /* of the fixed-interface problem, up to the last mode kept */
  CMSCount model;           /* of the free model, up to the last mode with an error estimate */
  CMSCount complete;        /* the largest range looked at in which none is missing */
} CMSQuality;

/* phase: "factorization", "constraint modes", ...; seconds: wall time of it on this rank. */
typedef PetscErrorCode (*CMSMonitorFunction)(CMS cms, const char phase[], PetscReal seconds,
                                             void* ctx);

/* fraction: of the phase that goes on, 0 to 1. */
typedef PetscErrorCode (*CMSProgressFunction)(CMS cms, const char phase[], PetscReal fraction,
                                              void* ctx);

PETSC_EXTERN PetscClassId CMS_CLASSID;

/* Registers class, log events and stages; CMSCreate and -dll_append do it by themselves. */
PETSC_EXTERN PetscErrorCode CMSInitializePackage(void);
/* The SLEPc solver type "blocklanczos"; -dll_append does it by itself. */
PETSC_EXTERN PetscErrorCode CMSRegisterEPS(void);

PETSC_EXTERN PetscErrorCode CMSCreate(MPI_Comm comm, CMS* cms);
PETSC_EXTERN PetscErrorCode CMSDestroy(CMS* cms);
/* Forgets results and factor, keeps operators, interface and settings. */
PETSC_EXTERN PetscErrorCode CMSReset(CMS cms);

/* Symmetric K, M and (or NULL) any C of one size and layout; K_ss positive definite, M
   semidefinite. C may be damping (symmetric), gyroscopic (skew-symmetric) or the sum. Any type that
   converts to AIJ. References are taken; call it again when the values changed. */
PETSC_EXTERN PetscErrorCode CMSSetOperators(CMS cms, Mat K, Mat M, Mat C);
PETSC_EXTERN PetscErrorCode CMSGetOperators(CMS cms, Mat* K, Mat* M, Mat* C);
/* Global indices of the masters, each once, on any rank. Their order is that of the reduced rows.
 */
PETSC_EXTERN PetscErrorCode CMSSetInterface(CMS cms, IS masters);
PETSC_EXTERN PetscErrorCode CMSGetInterface(CMS cms, IS* masters);
/* For the file only: node, component (0..5 = x y z rx ry rz) and position (x y z in m) of each
   master in the order of this rank's part of the interface. Without it, a block size b <= 6 of K
   makes nodes of b components; positions are zero. */
PETSC_EXTERN PetscErrorCode CMSSetInterfaceGeometry(CMS cms, PetscInt n, const PetscInt nodes[],
                                                    const PetscInt components[],
                                                    const PetscReal positions[]);
/* The support: masters that will be held, global indices, each once, on any rank; NULL (default): none.
   Frequencies, errors and counts are those of the body that is held so, and mixed-interface modes too.
   Other supports remain possible, since all masters remain rows of the reduced model. */
PETSC_EXTERN PetscErrorCode CMSSetHeld(CMS cms, IS held);
/* Rows wanted by CMSGetTransformation, global indices; NULL (default): all rows, laid out as K. */
PETSC_EXTERN PetscErrorCode CMSSetOutput(CMS cms, IS rows);

/* -cms_type guyan|craig-bampton|mixed-interface|rubin|macneal|auto */
PETSC_EXTERN PetscErrorCode CMSSetType(CMS cms, CMSType type);
PETSC_EXTERN PetscErrorCode CMSGetType(CMS cms, CMSType* type);
/* How many modes; the last of the three that is set counts.
   -cms_nmodes N | -cms_cutoff F | -cms_tol T -cms_tol_upto F;  F in Hz: lambda = (2 pi F)^2.
   By tolerance: as many as keep the estimated relative error of all frequencies up to F below T; of
   the mixed interface all modes up to F. CMSAUTO needs a tolerance. */
PETSC_EXTERN PetscErrorCode CMSSetDimensions(CMS cms, PetscInt nmodes);
PETSC_EXTERN PetscErrorCode CMSSetCutoff(CMS cms, PetscReal f);
PETSC_EXTERN PetscErrorCode CMSSetTolerance(CMS cms, PetscReal tol, PetscReal upto);
/* Masters (valid after CMSSetUp) and fixed-interface modes (after CMSSolve). */
PETSC_EXTERN PetscErrorCode CMSGetDimensions(CMS cms, PetscInt* nmasters, PetscInt* nmodes);
/* Count eigenvalues by Sylvester's law; costs two to four more factorisations.
   -cms_sylvester */
PETSC_EXTERN PetscErrorCode CMSSetSylvester(CMS cms, PetscBool count);

PETSC_EXTERN PetscErrorCode CMSSetOptionsPrefix(CMS cms, const char prefix[]);
PETSC_EXTERN PetscErrorCode CMSAppendOptionsPrefix(CMS cms, const char prefix[]);
PETSC_EXTERN PetscErrorCode CMSGetOptionsPrefix(CMS cms, const char* prefix[]);
PETSC_EXTERN PetscErrorCode CMSSetFromOptions(CMS cms);
/* Called at the end of each phase; -cms_monitor prints. */
PETSC_EXTERN PetscErrorCode CMSMonitorSet(CMS cms, CMSMonitorFunction monitor, void* ctx);
/* Called on each rank by itself while a long phase goes on. An error that it returns ends the work: at once
   where there is one rank, at the end of the phase where there are several. */
PETSC_EXTERN PetscErrorCode CMSProgressSet(CMS cms, CMSProgressFunction progress, void* ctx);

/* Checks the input, partitions, factors K_ss. */
PETSC_EXTERN PetscErrorCode CMSSetUp(CMS cms);
/* Reduces and estimates the errors; calls CMSSetUp, obeys -cms_view. */
PETSC_EXTERN PetscErrorCode CMSSolve(CMS cms);

/* Dense, distributed, owned by the object. C is NULL without damping. NULL: not wanted. */
PETSC_EXTERN PetscErrorCode CMSGetReducedOperators(CMS cms, Mat* K, Mat* M, Mat* C);
/* T with K_r = T^T K T: u = T (u_m, q). Dense, made at the first call, owned by the object. */
PETSC_EXTERN PetscErrorCode CMSGetTransformation(CMS cms, Mat* T);
/* Elastic modes of the reduced model under the support of CMSSetHeld, ascending, f in Hz, up to the
   highest fixed-interface mode or the last mixed-interface one, at most 100; of Guyan the lowest 20. Arrays are owned by the object. */
PETSC_EXTERN PetscErrorCode CMSGetFrequencies(CMS cms, PetscInt* n, const PetscReal* f[]);
/* eta^2 of the same modes: estimated relative error of lambda; half of it for f. MacNeal's method has
   no such estimate: n is 0, and there is nothing to read. */
PETSC_EXTERN PetscErrorCode CMSGetErrors(CMS cms, PetscInt* n, const PetscReal* eta2[]);
/* What rounding may have done to lambda of the same modes, relative; beyond what eta^2 tells. */
PETSC_EXTERN PetscErrorCode CMSGetRounding(CMS cms, PetscInt* n, const PetscReal* rounding[]);
/* Upper bounds of the relative errors of lambda of the first n <= N modes (Temple, Lehmann), below
   the frequency up to which -cms_sylvester found no eigenvalue missing; n = 0 without a count. What
   rounding of K may do is in them to first order. */
PETSC_EXTERN PetscErrorCode CMSGetErrorBounds(CMS cms, PetscInt* n, const PetscReal* bounds[]);
PETSC_EXTERN PetscErrorCode CMSGetQuality(CMS cms, CMSQuality* quality);

/* ascii, or hdf5: the reduced file of docs/reference/file_formats.md. -cms_view [ascii|hdf5:FILE] */
PETSC_EXTERN PetscErrorCode CMSView(CMS cms, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode CMSViewFromOptions(CMS cms, PetscObject prefixed, const char name[]);
/* The reduced file, complete or not at all: an interrupted run leaves an older one untouched. */
PETSC_EXTERN PetscErrorCode CMSWrite(CMS cms, const char filename[]);

#endif
