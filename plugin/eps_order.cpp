#include "plugin/eps_order.hpp"

#include <slepc/private/epsimpl.h>

#include "common/petsc.hpp"

namespace chladni::plugin {

namespace {

/// For the Rayleigh quotients of a transformation without an inverse.
PetscErrorCode sort_projected_values_alike(EPS eps)
{
  SlepcSC projected = nullptr;
  PetscFunctionBegin;
  PetscCall(DSGetSlepcSC(eps->ds, &projected));
  projected->comparison = eps->sc->comparison;
  projected->comparisonctx = eps->sc->comparisonctx;
  projected->map = nullptr;
  projected->mapobj = nullptr;
  projected->rg = nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode set_up_own_sort(EPS eps)
{
  PetscFunctionBegin;
  eps->sc->map = nullptr;
  eps->sc->mapobj = nullptr;
  if (eps->which == EPS_WHICH_USER)
    PetscFunctionReturn(0);  // EPSSetEigenvalueComparison has set it
  eps->sc->comparisonctx = nullptr;
  switch (eps->which) {
    case EPS_LARGEST_MAGNITUDE:
      eps->sc->comparison = SlepcCompareLargestMagnitude;
      break;
    case EPS_SMALLEST_MAGNITUDE:
      eps->sc->comparison = SlepcCompareSmallestMagnitude;
      break;
    case EPS_LARGEST_REAL:
      eps->sc->comparison = SlepcCompareLargestReal;
      break;
    case EPS_SMALLEST_REAL:
      eps->sc->comparison = SlepcCompareSmallestReal;
      break;
    case EPS_TARGET_MAGNITUDE:
    case EPS_TARGET_REAL:  // the same for real eigenvalues
      eps->sc->comparison = SlepcCompareTargetMagnitude;
      eps->sc->comparisonctx = &eps->target;
      break;
    case EPS_ALL:
      eps->sc->comparison = SlepcCompareSmallestReal;
      break;
    default:
      SETERRQ(PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
              "blocklanczos: the eigenvalues of a symmetric problem have no imaginary part; use "
              "another -eps_which");
  }
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode set_up_sort(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(set_up_own_sort(eps));
  PetscCall(sort_projected_values_alike(eps));
  PetscFunctionReturn(0);
}

bool comes_before(EPS eps, PetscScalar a, PetscScalar b)
{
  PetscScalar zero_a = 0.0, zero_b = 0.0;
  PetscInt order = 0;
  petsc::check(STBackTransform(eps->st, 1, &a, &zero_a));
  petsc::check(STBackTransform(eps->st, 1, &b, &zero_b));
  petsc::check(eps->sc->comparison(a, 0.0, b, 0.0, &order, eps->sc->comparisonctx));
  return order < 0;
}

}  // namespace chladni::plugin
