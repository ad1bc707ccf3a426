/* Cyclic symmetry: the operators of a CMS are those of one of N equal sectors, and the harmonics of
   the whole body are reduced one by one.

     CMSSetOperators(cms, K, M, NULL);            of one sector, both cut edges free
     CMSSetCyclic(cms, N, low, high, b, rotation);
     for (n = 0; n <= N / 2; n++) {
       CMSSetHarmonic(cms, n);
       CMSSolve(cms);
       CMSGetReducedOperators(cms, &Kr, &Mr, NULL);
     }

   In harmonic n the first sector moves as x, and sector j as R^j (cos(j mu) x - sin(j mu) y) with
   mu = 2 pi n / N and the rotation R. The harmonics 0 and N / 2 have no y and half the unknowns. In
   the other harmonics every eigenvalue is double, since (-y, x) is a mode as (x, y) is. */
#ifndef CHLADNI_CMS_CYCLIC_H
#define CHLADNI_CMS_CYCLIC_H

#include "chladni_cms.h"

/* Declares that operators and interface are those of one of count >= 2 equal sectors. The turn by
   one sector takes row k of low to row k of high (global rows of K in any order, on any rank). Rows
   come in blocks of b, the components of a node; rotation is their R [b x b, row by row], or NULL
   if the components turn with the sector, as scalars and cylindrical components do. A node that all
   sectors share, such as one on the axis, stands in low and in high at the same place; of its rows
   that an oblique axis turns into each other, all are masters (and held) or none. count = 0 removes
   the declaration. */
PETSC_EXTERN PetscErrorCode CMSSetCyclic(CMS cms, PetscInt count, IS low, IS high, PetscInt b,
                                         const PetscReal rotation[]);
/* Sets the harmonic, 0 .. count / 2; 0 by default. Deletes the results of another harmonic.
   -cms_harmonic n */
PETSC_EXTERN PetscErrorCode CMSSetHarmonic(CMS cms, PetscInt n);
PETSC_EXTERN PetscErrorCode CMSGetHarmonic(CMS cms, PetscInt* n);

/* Return the real matrices of the harmonic, for an EPS for example, and the matrices X and Y of its
   coordinates c: x = X c, y = Y c in the rows of the sector. The energy c^T K c / 2 is that of the
   whole body. Made at the first call or by CMSSetUp, owned by the object; C and Y may be NULL. No
   interface is needed. */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicOperators(CMS cms, Mat* K, Mat* M, Mat* C);
PETSC_EXTERN PetscErrorCode CMSGetHarmonicCoordinates(CMS cms, Mat* X, Mat* Y);
/* Returns the meaning of the first n rows of the reduced operators, those before the modes: row i
   is x (phase 0) or y (phase 1) of the row rows[i] of the sector. First come x of all masters in
   the order of CMSSetInterface, then y of all. Masters of shared nodes appear only where the
   harmonic moves them. Valid after CMSSetUp. */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicInterface(CMS cms, PetscInt* n, const PetscInt* rows[],
                                                    const PetscInt* phases[]);
/* Returns T_x and T_y with x = T_x (u_m, q), y = T_y (u_m, q). T_x is also the result of
   CMSGetTransformation; T_y may be NULL. */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicTransformation(CMS cms, Mat* T_x, Mat* T_y);

#endif
