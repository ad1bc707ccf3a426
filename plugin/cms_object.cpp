// The life of a CMS: package, create, set, reset, destroy.
#include <slepceps.h>

#include <array>
#include <cmath>
#include <string_view>

#include "common/petsc_compat.hpp"
#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

PetscClassId CMS_CLASSID = 0;

namespace chladni::plugin {

Events events;

namespace {

struct NamedEvent {
  PetscLogEvent Events::*event;
  const char* name;
};

constexpr std::array named_events{
    NamedEvent{&Events::set_up, "CMSSetUp"},      NamedEvent{&Events::check, "CMSCheck"},
    NamedEvent{&Events::harmonic, "CMSHarmonic"}, NamedEvent{&Events::solve, "CMSSolve"},
    NamedEvent{&Events::factor, "CMSFactor"},     NamedEvent{&Events::constraint, "CMSConstraint"},
    NamedEvent{&Events::modes, "CMSModes"},       NamedEvent{&Events::project, "CMSProject"},
    NamedEvent{&Events::errors, "CMSErrors"},     NamedEvent{&Events::count, "CMSSylvester"},
    NamedEvent{&Events::view, "CMSWrite"},
};

/// After PetscFinalize a second PetscInitialize begins anew.
PetscErrorCode forget_package()
{
  CMS_CLASSID = 0;
  return 0;
}

}  // namespace

PetscErrorCode refuse_at_work(CMS cms, const char* function)
{
  PetscFunctionBegin;
  PetscCheck(!cms->inside->is_at_work, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "%s() was called by a monitor, while CMSSetUp() or CMSSolve() works on this object; "
             "call it afterwards, or let the monitor return an error code to end the work",
             function);
  PetscFunctionReturn(0);
}

}  // namespace chladni::plugin

using namespace chladni;  // NOLINT(google-build-using-namespace): C functions, but C++ inside
using namespace plugin;   // NOLINT(google-build-using-namespace)

PetscErrorCode CMSInitializePackage()
{
  PetscFunctionBegin;
  if (CMS_CLASSID != 0) PetscFunctionReturn(0);
  PetscCall(EPSInitializePackage());
  PetscCall(PetscClassIdRegister("Component Mode Synthesis", &CMS_CLASSID));
  for (const NamedEvent& named : named_events)
    PetscCall(PetscLogEventRegister(named.name, CMS_CLASSID, &(events.*named.event)));
  PetscCall(PetscLogStageRegister("CMS set-up", &events.stage_set_up));
  PetscCall(PetscLogStageRegister("CMS solve", &events.stage_solve));
  PetscCall(PetscRegisterFinalize(forget_package));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSCreate(MPI_Comm comm, CMS* newcms)
{
  CMS cms = nullptr;
  PetscFunctionBegin;
  PetscAssertPointer(newcms, 2);
  *newcms = nullptr;
  PetscCheck(SlepcInitializeCalled, comm, PETSC_ERR_ORDER,
             "CMS needs SLEPc: call SlepcInitialize instead of PetscInitialize");
  PetscCall(CMSInitializePackage());
  PetscCall(PetscHeaderCreate(cms, CMS_CLASSID, "CMS", "Component mode synthesis", "CMS", comm,
                              CMSDestroy, CMSView));
  PetscCallCXX(cms->inside = new Inside);
  PetscCall(CMSSetType(cms, CMSCRAIGBAMPTON));
  *newcms = cms;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSDestroy(CMS* cms)
{
  PetscFunctionBegin;
  if (!*cms) PetscFunctionReturn(0);
  PetscValidHeaderSpecific(*cms, CMS_CLASSID, 1);
  if (((PetscObject)*cms)->refct == 1) PetscCall(refuse_at_work(*cms, __func__));
  if (--((PetscObject)*cms)->refct > 0) {
    *cms = nullptr;
    PetscFunctionReturn(0);
  }
  delete (*cms)->inside;
  PetscCall(PetscHeaderDestroy(cms));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSReset(CMS cms)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  cms->inside->result.reset();
  cms->inside->set_up.reset();
  cms->inside->problem.reset();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetOperators(CMS cms, Mat K, Mat M, Mat C)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidHeaderSpecific(K, MAT_CLASSID, 2);
  PetscValidHeaderSpecific(M, MAT_CLASSID, 3);
  PetscCheckSameComm(cms, 1, K, 2);
  PetscCheckSameComm(cms, 1, M, 3);
  if (C) {
    PetscValidHeaderSpecific(C, MAT_CLASSID, 4);
    PetscCheckSameComm(cms, 1, C, 4);
  }
  PetscCall(CMSReset(cms));
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    cms->inside->K = reference<petsc::Matrix>(K);
    cms->inside->M = reference<petsc::Matrix>(M);
    cms->inside->C = reference<petsc::Matrix>(C);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetOperators(CMS cms, Mat* K, Mat* M, Mat* C)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  if (K) *K = cms->inside->K;
  if (M) *M = cms->inside->M;
  if (C) *C = cms->inside->C;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetInterface(CMS cms, IS masters)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidHeaderSpecific(masters, IS_CLASSID, 2);
  PetscCheckSameComm(cms, 1, masters, 2);
  PetscCall(CMSReset(cms));
  cms->inside->geometry.clear();
  PetscCall(guarded((PetscObject)cms, __func__,
                    [&] { cms->inside->interface = reference<petsc::IndexSet>(masters); }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetInterface(CMS cms, IS* masters)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(masters, 2);
  *masters = cms->inside->interface;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetInterfaceGeometry(CMS cms, PetscInt n, const PetscInt nodes[],
                                       const PetscInt components[], const PetscReal positions[])
{
  PetscInt n_local = 0;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscCheck(cms->inside->interface, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "Call CMSSetInterface() before CMSSetInterfaceGeometry()");
  PetscCall(ISGetLocalSize(cms->inside->interface, &n_local));
  int wrong = n == n_local ? 0 : 1;
  for (PetscInt i = 0; wrong == 0 && i < n; ++i) wrong = components[i] < 0 || components[i] > 5;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPI_INT, MPI_MAX, PetscObjectComm((PetscObject)cms)));
  PetscCheck(wrong == 0, PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_OUTOFRANGE,
             "A rank gives places for another number of masters than its part of the interface "
             "has, or a component outside 0..5 (x y z rx ry rz)");
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    std::vector<MasterPlace> geometry;
    for (PetscInt i = 0; i < n; ++i) {
      const PetscReal* x = positions + 3 * i;
      geometry.push_back({.node = nodes[i], .component = components[i], .x = {x[0], x[1], x[2]}});
    }
    cms->inside->geometry = std::move(geometry);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetHeld(CMS cms, IS held)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  if (held) PetscValidHeaderSpecific(held, IS_CLASSID, 2);
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    cms->inside->held = reference<petsc::IndexSet>(held);
    cms->inside->result.reset();
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetOutput(CMS cms, IS rows)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  if (rows) PetscValidHeaderSpecific(rows, IS_CLASSID, 2);
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    cms->inside->output = reference<petsc::IndexSet>(rows);
    if (auto& result = cms->inside->result) {
      result->T = {};
      result->T_y = {};
    }
  }));
  PetscFunctionReturn(0);
}
