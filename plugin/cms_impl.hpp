#pragma once

#include <petsc/private/petscimpl.h>
#include <petscsys.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "linear/progress.hpp"
#include "plugin/chladni_cms_cyclic.h"
#include "plugin/cms_operators.hpp"
#include "reduce/reduction.hpp"

/// The inside of the PETSc class CMS. Nothing of it appears in the C header.

namespace chladni::plugin {

/// Node, component and position of a master, for the file.
struct MasterPlace {
  PetscInt node;
  PetscInt component;
  double x[3];  ///< m
};

/// The result of CMSSetUp.
struct SetUp {
  reduce::FactoredBody body;  ///< its K and M are references, or AIJ copies of other types
  VelocityForces velocity;    ///< C as a reference or an AIJ copy; empty without C
};

/// The result of CMSSolve, with masters in the user's order, then the modes.
struct Result {
  reduce::Reduction reduction;
  std::vector<PetscReal> f_Hz;  ///< [k] of the certified modes
  CMSQuality quality;
  /// Made at the first call that asks for them. C_r exists only with C, T_y only for a harmonic
  /// with two phases.
  petsc::Matrix K_r = {}, M_r = {}, C_r = {}, T = {}, T_y = {};
};

/// The user's settings.
struct Settings {
  reduce::ReductionOptions options{.basis = {.method = reduce::Method::craig_bampton, .modes = 20}};
  CMSMonitorFunction monitor = nullptr;
  void* monitor_context = nullptr;
  CMSProgressFunction progress = nullptr;
  void* progress_context = nullptr;
  bool prints_phases = false;
};

/// The members of a CMS.
struct Inside {
  petsc::Matrix K, M, C;                    ///< as given
  petsc::IndexSet interface, held, output;  ///< as given
  std::vector<MasterPlace> geometry;        ///< of this rank's part of the interface; may be empty
  std::optional<Sectors> sectors;           ///< as given
  PetscInt harmonic = 0;
  Settings settings;
  std::optional<HarmonicProblem> problem;  ///< set with sectors only
  std::optional<SetUp> set_up;
  std::optional<Result> result;
  bool is_at_work = false;  ///< in CMSSetUp or CMSSolve, which may call functions of the user
};

struct Events {
  PetscLogEvent set_up, check, harmonic, solve, factor, constraint, modes, project, errors, count,
      view;
  PetscLogStage stage_set_up, stage_solve;
};
extern Events events;

/// Another reference to a PETSc object; empty for null.
template <class Handle, class Object>
Handle reference(Object object)
{
  if (object) petsc::check(PetscObjectReference(reinterpret_cast<PetscObject>(object)));
  return Handle(object);
}

/// A phase of the work, from construction to `done`: logs its event, measures its wall time and
/// reports its progress to the user's function. With -cms_monitor on a terminal it prints the
/// remaining time.
class Phase {
 public:
  Phase(CMS cms, PetscLogEvent event, std::string name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;
  /// Calls the monitor. It is not called when an exception ends the phase.
  void done();

 private:
  void listen();
  void show(double fraction);
  void tell(double fraction);
  void call_monitor(PetscLogDouble seconds);

  CMS cms_;
  PetscLogEvent event_;
  std::string name_;
  PetscLogDouble started_ = 0.0;
  PetscLogDouble shown_ = 0.0;
  int users_code_ = 0;  ///< returned by the progress function on this rank
  std::optional<linear::ListenToProgress> listener_;
};

/// Turns the phases of a reduction into phases of a CMS. Short ones are left out.
class CMSPhases : public reduce::PhaseListener {
 public:
  explicit CMSPhases(CMS cms) : cms_(cms) {}

 private:
  void begun(const std::string& name) override;
  void ended() override;

  CMS cms_;
  std::optional<Phase> phase_;
};

/// The options `-PREFIXcms_...` of the object, in its own database, for the solvers inside.
linear::OptionSource option_source(CMS cms);

/// An error while CMSSetUp or CMSSolve is at work, so that a monitor cannot take away what they
/// work on; 0 otherwise.
PetscErrorCode refuse_at_work(CMS cms, const char* function);

/// Does the work of CMSSetUp.
/// @throws chladni::Error on all ranks when the operators or the interface cannot be reduced.
SetUp make_set_up(CMS cms);
/// The matrices of the harmonic of the sectors, made at the first call.
/// @throws chladni::Error on all ranks when CMSSetCyclic was not called or its edges do not match.
HarmonicProblem& made_problem(CMS cms);
/// Does the work of CMSSolve.
Result make_result(CMS cms);
/// The rows held by CMSSetHeld, the same on every rank.
/// @note   Collective.
std::vector<PetscInt> held_masters(const Inside& inside);
/// Makes T, and T_y for a harmonic, with the rows that CMSSetOutput asks for.
void make_transformation(Inside& in);
/// T^T C T with masters ascending by DOF; symmetric if C is.
Eigen::MatrixXd reduced_velocity_forces(const Inside& in);
/// Writes the reduced file.
void write_file(CMS cms, const std::string& path);

}  // namespace chladni::plugin

struct _CMSOps {};

/// The object behind the handle CMS of the C header.
struct _p_CMS {
  PETSCHEADER(struct _CMSOps);
  chladni::plugin::Inside* inside;
};

namespace chladni::plugin {

/// An error returned by a function of the user's program that was called from a solution.
class UsersFailure : public Error {
 public:
  UsersFailure(PetscErrorCode error_code, const std::string& text) : Error(text), code(error_code)
  {}
  PetscErrorCode code;
};

/// Ends all ranks after memory ran out on this one, since the others would wait for it forever. On
/// a single rank returns PETSC_ERR_MEM instead. Prints its own message, because an error handler
/// may suppress PETSc's.
inline PetscErrorCode without_memory(MPI_Comm comm)
{
  if (petsc::size(comm) == 1) return PETSC_ERR_MEM;
  std::fprintf(stderr,
               "chladni: rank %d has not enough memory, so all ranks end; use more machines or ask "
               "for fewer modes\n",
               petsc::rank(comm));
  MPI_Abort(comm, PETSC_ERR_MEM);
  return PETSC_ERR_MEM;
}

/// Runs work() and turns exceptions into PETSc errors, so that none reaches C. Errors of the
/// library are thrown on all ranks and reported once; memory that runs out on one rank ends all
/// ranks.
template <class Work>
PetscErrorCode guarded(PetscObject object, const char* function, const Work& work) noexcept
{
  const MPI_Comm comm = object ? PetscObjectComm(object) : PETSC_COMM_SELF;
  const auto report = [&](MPI_Comm where, PetscErrorCode code, const char* text) {
    return PetscError(where, __LINE__, function, __FILE__, code, PETSC_ERROR_INITIAL, "%s", text);
  };
  try {
    work();
    return 0;
  } catch (const petsc::Failure& failure) {  // PETSc has reported it already
    const PetscErrorCode code =
        PetscError(comm, __LINE__, function, __FILE__, failure.code, PETSC_ERROR_REPEAT, " ");
    return code == PETSC_ERR_MEM ? without_memory(comm) : code;
  } catch (const std::bad_alloc&) {
    report(PETSC_COMM_SELF, PETSC_ERR_MEM,
           "not enough memory; use more ranks on more machines or fewer modes");
    return without_memory(comm);
  } catch (const UsersFailure& failure) {
    return report(comm, failure.code, failure.what());
  } catch (const Error& error) {
    return report(comm, PETSC_ERR_USER_INPUT, error.what());
  } catch (const std::exception& error) {
    return report(comm, PETSC_ERR_LIB, error.what());
  } catch (...) {
    return report(PETSC_COMM_SELF, PETSC_ERR_LIB, "unknown C++ exception");
  }
}

}  // namespace chladni::plugin
