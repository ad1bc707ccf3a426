// The life of a CMS: package, create, set, reset, destroy.

#include <petscviewer.h>
#include <slepceps.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "common/petsc.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/solver_options.hpp"
#include "plugin/chladni_cms.h"
#include "plugin/cms_impl.hpp"

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

namespace chladni::plugin {

// What may be chosen, by calls and by options.

namespace {

constexpr std::array<const char*, 5> type_names{CMSGUYAN, CMSCRAIGBAMPTON, CMSMIXED, CMSRUBIN,
                                                CMSAUTO};
constexpr std::array types{reduce::Method::guyan, reduce::Method::craig_bampton,
                           reduce::Method::mixed_interface, reduce::Method::rubin,
                           reduce::Method::automatic};

}  // namespace

linear::OptionSource option_source(CMS cms)
{
  const auto object = reinterpret_cast<PetscObject>(cms);
  return {.database = object->options,
          .prefix = fmt::format("{}cms_", object->prefix ? object->prefix : "")};
}

namespace {

/// The factor and the modes are made anew where their solvers are others now.
void read_solver(CMS cms)
{
  Settings& settings = cms->inside->settings;
  settings.options.solver.petsc = option_source(cms);
  linear::SolverOptions& known = settings.options.solver;
  linear::SolverOptions solver =
      linear::read_solver_options(PetscObjectComm((PetscObject)cms), known);
  if (solver == known) return;
  petsc::check(CMSReset(cms));
  known = std::move(solver);
}

}  // namespace

}  // namespace chladni::plugin

using namespace chladni::reduce;  // NOLINT(google-build-using-namespace)
using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

PetscErrorCode CMSSetType(CMS cms, CMSType type)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (std::strcmp(type, type_names[i]) != 0) continue;
    if (cms->inside->settings.options.basis.method != types[i]) cms->inside->result.reset();
    cms->inside->settings.options.basis.method = types[i];
    PetscCall(PetscObjectChangeTypeName((PetscObject)cms, type_names[i]));
    PetscFunctionReturn(0);
  }
  PetscCheck(
      std::strcmp(type, "macneal") != 0, PetscObjectComm((PetscObject)cms),
      PETSC_ERR_ARG_UNKNOWN_TYPE,
      "CMS type \"macneal\" is gone, since it was no better than %s; give -cms_type %s, which "
      "has the same modes",
      CMSCRAIGBAMPTON, CMSRUBIN);
  SETERRQ(PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_UNKNOWN_TYPE,
          "Unknown CMS type \"%s\"; give -cms_type %s, %s, %s, %s or %s", type, CMSGUYAN,
          CMSCRAIGBAMPTON, CMSMIXED, CMSRUBIN, CMSAUTO);
}

PetscErrorCode CMSGetType(CMS cms, CMSType* type)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(type, 2);
  *type = ((PetscObject)cms)->type_name;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetDimensions(CMS cms, PetscInt nmodes)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscValidLogicalCollectiveInt(cms, nmodes, 2);
  PetscCheck(nmodes > 0, PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " modes; give at least one, or -cms_type guyan for none", nmodes);
  cms->inside->settings.options.basis = {.method = cms->inside->settings.options.basis.method,
                                         .modes = static_cast<int>(nmodes)};
  cms->inside->result.reset();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetCutoff(CMS cms, PetscReal f)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscValidLogicalCollectiveReal(cms, f, 2);
  PetscCheck(f > 0.0 && std::isfinite(f), PetscObjectComm((PetscObject)cms),
             PETSC_ERR_ARG_OUTOFRANGE, "Cut-off %g Hz; give a positive -cms_cutoff", (double)f);
  cms->inside->settings.options.basis = {.method = cms->inside->settings.options.basis.method,
                                         .cutoff_Hz = f};
  cms->inside->result.reset();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetTolerance(CMS cms, PetscReal tol, PetscReal upto)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscValidLogicalCollectiveReal(cms, tol, 2);
  PetscValidLogicalCollectiveReal(cms, upto, 3);
  PetscCheck(tol > 0.0 && tol < 1.0 && upto > 0.0 && std::isfinite(upto),
             PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_OUTOFRANGE,
             "Tolerance %g up to %g Hz; give -cms_tol between 0 and 1 and a positive -cms_tol_upto",
             (double)tol, (double)upto);
  cms->inside->settings.options.basis = {
      .method = cms->inside->settings.options.basis.method,
      .tolerance = ModesByTolerance{.tolerance = tol, .up_to_Hz = upto}};
  cms->inside->result.reset();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetSylvester(CMS cms, PetscBool count)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscValidLogicalCollectiveBool(cms, count, 2);
  auto& counts = cms->inside->settings.options.count;
  if (counts != (count == PETSC_TRUE)) cms->inside->result.reset();
  counts = count == PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetOptionsPrefix(CMS cms, const char prefix[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)cms, prefix));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSAppendOptionsPrefix(CMS cms, const char prefix[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(PetscObjectAppendOptionsPrefix((PetscObject)cms, prefix));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetOptionsPrefix(CMS cms, const char* prefix[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(prefix, 2);
  PetscCall(PetscObjectGetOptionsPrefix((PetscObject)cms, prefix));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSMonitorSet(CMS cms, CMSMonitorFunction monitor, void* ctx)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  cms->inside->settings.monitor = monitor;
  cms->inside->settings.monitor_context = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSProgressSet(CMS cms, CMSProgressFunction progress, void* ctx)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  cms->inside->settings.progress = progress;
  cms->inside->settings.progress_context = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetFromOptions(CMS cms)
{
  PetscInt n_modes = 20;
  PetscInt type = 1;
  PetscReal cutoff = 0.0;
  PetscReal tolerance = 0.0;
  PetscReal up_to = 0.0;
  std::array<char, PETSC_MAX_PATH_LEN> view{};
  PetscBool type_given = PETSC_FALSE;
  PetscBool modes_given = PETSC_FALSE;
  PetscBool cutoff_given = PETSC_FALSE;
  PetscBool tolerance_given = PETSC_FALSE;
  PetscBool up_to_given = PETSC_FALSE;
  PetscBool harmonic_given = PETSC_FALSE;
  PetscInt harmonic = 0;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  Settings& settings = cms->inside->settings;
  PetscBool sylvester = settings.options.count == true ? PETSC_TRUE : PETSC_FALSE;
  PetscBool monitor = settings.prints_phases ? PETSC_TRUE : PETSC_FALSE;
  PetscObjectOptionsBegin((PetscObject)cms);
  PetscCall(PetscOptionsEList("-cms_type", "Method of reduction", "CMSSetType", type_names.data(),
                              type_names.size(), type_names[type], &type, &type_given));
  PetscCall(PetscOptionsInt("-cms_nmodes", "Number of modes of the method", "CMSSetDimensions",
                            n_modes, &n_modes, &modes_given));
  PetscCall(PetscOptionsReal("-cms_cutoff", "All modes of the method below this, Hz",
                             "CMSSetCutoff", cutoff, &cutoff, &cutoff_given));
  PetscCall(PetscOptionsReal("-cms_tol",
                             "As many modes as keep the error of frequencies below this",
                             "CMSSetTolerance", tolerance, &tolerance, &tolerance_given));
  PetscCall(PetscOptionsReal("-cms_tol_upto", "Range of -cms_tol, Hz", "CMSSetTolerance", up_to,
                             &up_to, &up_to_given));
  PetscCall(PetscOptionsInt("-cms_harmonic", "Harmonic of the sectors", "CMSSetHarmonic", harmonic,
                            &harmonic, &harmonic_given));
  PetscCall(PetscOptionsBool(
      "-cms_sylvester", "Count eigenvalues by Sylvester's law, by two to four more factorisations",
      "CMSSetSylvester", sylvester, &sylvester, nullptr));
  PetscCall(PetscOptionsBool("-cms_monitor", "Print each phase with its time", "CMSMonitorSet",
                             monitor, &monitor, nullptr));
  // As text: PETSc's own would create, and so empty, the file before there is a result.
  PetscCall(PetscOptionsString("-cms_view", "View the result: ascii, or hdf5:FILE", "CMSView", "",
                               view.data(), view.size(), nullptr));
  PetscCall(PetscObjectProcessOptionsHandlers((PetscObject)cms, PetscOptionsObject));
  PetscOptionsEnd();
  const int n_given = modes_given + cutoff_given + tolerance_given;
  PetscCheck(n_given <= 1 && tolerance_given == up_to_given, PetscObjectComm((PetscObject)cms),
             PETSC_ERR_USER_INPUT,
             "Give one of -cms_nmodes N, -cms_cutoff F and -cms_tol T -cms_tol_upto F");
  if (type_given) PetscCall(CMSSetType(cms, type_names[type]));
  if (modes_given) PetscCall(CMSSetDimensions(cms, n_modes));
  if (cutoff_given) PetscCall(CMSSetCutoff(cms, cutoff));
  if (tolerance_given) PetscCall(CMSSetTolerance(cms, tolerance, up_to));
  if (harmonic_given) PetscCall(CMSSetHarmonic(cms, harmonic));
  PetscCall(CMSSetSylvester(cms, sylvester));
  settings.prints_phases = monitor == PETSC_TRUE;
  PetscCall(guarded((PetscObject)cms, __func__, [&] { read_solver(cms); }));
  PetscFunctionReturn(0);
}

// What -dll_append finds in libchladni_petsc.so.

extern "C" PETSC_VISIBILITY_PUBLIC PetscErrorCode PetscDLLibraryRegister_chladni_petsc();

/// Called by PETSc when a library is loaded; a wrong name would be passed over in silence.
PetscErrorCode PetscDLLibraryRegister_chladni_petsc()
{
  PetscFunctionBegin;
  PetscCall(CMSInitializePackage());
  PetscCall(CMSRegisterEPS());
  PetscCall(chladni::plugin::guarded(nullptr, __func__,
                                     [] { chladni::linear::register_cholesky_types(); }));
  PetscFunctionReturn(0);
}
