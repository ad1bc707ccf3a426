/* Sectors: the operators of a CMS as those of one of N equal sectors, reduced harmonic by harmonic.

     CMSSetOperators(cms, K, M, NULL);            of one sector, both cut edges free
     CMSSetCyclic(cms, N, low, high, b, rotation);
     for (n = 0; n <= N / 2; n++) {
       CMSSetHarmonic(cms, n);
       CMSSolve(cms);
       CMSGetReducedOperators(cms, &Kr, &Mr, NULL);
     }

   In harmonic n the first sector moves as x, and sector j as R^j (cos(j mu) x - sin(j mu) y) with
   mu = 2 pi n / N and the rotation R; n = 0 and N / 2 have no y, and half the unknowns. A quarter
   of a period later (x, y) is (-y, x): every eigenvalue of the other harmonics is double. */
#ifndef CHLADNI_CMS_CYCLIC_H
#define CHLADNI_CMS_CYCLIC_H

#include "chladni_cms.h"

/* Operators and interface are those of one of count >= 2 sectors. Row k of low (global rows of K in
   any order, on any rank) is taken by the turn of a sector to row k of high. Rows come in blocks of
   b, the components of a node; rotation is their R [b x b, row by row], NULL where components turn
   with the sector, as scalars and those of cylindrical coordinates. A node that all sectors share,
   such as one on the axis, is in low and in high at the same place. count = 0 takes all of it back.
 */
PETSC_EXTERN PetscErrorCode CMSSetCyclic(CMS cms, PetscInt count, IS low, IS high, PetscInt b,
                                         const PetscReal rotation[]);
/* 0 .. count / 2; 0 by default. Forgets the results of another one.
   -cms_harmonic n */
PETSC_EXTERN PetscErrorCode CMSSetHarmonic(CMS cms, PetscInt n);
PETSC_EXTERN PetscErrorCode CMSGetHarmonic(CMS cms, PetscInt* n);

/* The real symmetric matrices of the harmonic, for an EPS say, and its coordinates c: x = X c, y =
   Y c in the rows of the sector. The energies c^T K c / 2 are those of the whole body. Made at the
   first call or by CMSSetUp, owned by the object; C and Y may be NULL. They need no interface. */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicOperators(CMS cms, Mat* K, Mat* M, Mat* C);
PETSC_EXTERN PetscErrorCode CMSGetHarmonicCoordinates(CMS cms, Mat* X, Mat* Y);
/* What the rows of the reduced operators before the modes are: x (phase 0) of the row rows[i] of
   the sector, or y (phase 1). First x of all masters as CMSSetInterface has them, then y of all; a
   master of a shared node is there where the harmonic moves it, in x. Valid after CMSSetUp. */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicInterface(CMS cms, PetscInt* n, const PetscInt* rows[],
                                                    const PetscInt* phases[]);
/* T_x is what CMSGetTransformation gives, x = T_x (u_m, q), and y = T_y (u_m, q); T_y may be NULL.
 */
PETSC_EXTERN PetscErrorCode CMSGetHarmonicTransformation(CMS cms, Mat* T_x, Mat* T_y);

#endif
