// A CMS of sectors: what CMSSetCyclic says, and the harmonic as matrices.
#include "common/petsc_compat.hpp"
#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

PetscErrorCode CMSSetCyclic(CMS cms, PetscInt count, IS low, IS high, PetscInt b,
                            const PetscReal rotation[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidLogicalCollectiveInt(cms, count, 2);
  if (count == 0) {
    PetscCall(CMSReset(cms));
    cms->inside->sectors.reset();
    PetscFunctionReturn(0);
  }
  PetscValidHeaderSpecific(low, IS_CLASSID, 3);
  PetscValidHeaderSpecific(high, IS_CLASSID, 4);
  PetscCheckSameComm(cms, 1, low, 3);
  PetscCheckSameComm(cms, 1, high, 4);
  PetscValidLogicalCollectiveInt(cms, b, 5);
  PetscCheck(b > 0, PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_OUTOFRANGE,
             "Block size %" PetscInt_FMT
             " of the rotation; give the components of a node, or 1 and no rotation",
             b);
  PetscCall(CMSReset(cms));
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    Sectors sectors{.count = static_cast<int>(count),
                    .low = reference<chladni::petsc::IndexSet>(low),
                    .high = reference<chladni::petsc::IndexSet>(high),
                    .R = Eigen::MatrixXd::Identity(b, b)};
    for (PetscInt i = 0; rotation && i < b * b; ++i) sectors.R(i / b, i % b) = rotation[i];
    cms->inside->sectors = std::move(sectors);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetHarmonic(CMS cms, PetscInt n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidLogicalCollectiveInt(cms, n, 2);
  if (n != cms->inside->harmonic) PetscCall(CMSReset(cms));
  cms->inside->harmonic = n;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonic(CMS cms, PetscInt* n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(n, 2);
  *n = cms->inside->harmonic;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicOperators(CMS cms, Mat* K, Mat* M, Mat* C)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { made_problem(cms); }));
  const Operators& operators = cms->inside->problem->operators;
  if (K) *K = operators.K;
  if (M) *M = operators.M;
  if (C) *C = operators.velocity.C;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicCoordinates(CMS cms, Mat* X, Mat* Y)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { made_problem(cms); }));
  if (X) *X = cms->inside->problem->harmonic.X;
  if (Y) *Y = cms->inside->problem->harmonic.Y;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicInterface(CMS cms, PetscInt* n, const PetscInt* rows[],
                                       const PetscInt* phases[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->set_up && cms->inside->problem, PetscObjectComm((PetscObject)cms),
             PETSC_ERR_ORDER, "Call CMSSetCyclic() and CMSSetUp() first");
  const HarmonicMasters& masters = cms->inside->problem->masters;
  if (n) *n = static_cast<PetscInt>(masters.rows.size());
  if (rows) *rows = masters.rows.data();
  if (phases) *phases = masters.phases.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicTransformation(CMS cms, Mat* T_x, Mat* T_y)
{
  Mat T = nullptr;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->sectors, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "Call CMSSetCyclic() first");
  PetscCall(CMSGetTransformation(cms, &T));
  if (T_x) *T_x = T;
  if (T_y) *T_y = cms->inside->result->T_y;
  PetscFunctionReturn(0);
}
