#pragma once

#include <petsc/private/petscimpl.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "linear/progress.hpp"
#include "plugin/chladni_cms_cyclic.h"
#include "plugin/harmonic_problem.hpp"
#include "reduce/reduction.hpp"

/// Inside of the PETSc class CMS; nothing of it crosses the C header.
namespace chladni::plugin {

/// Where a master stands, for the file.
struct MasterPlace {
  PetscInt node;
  PetscInt component;
  double x[3];
};

/// What CMSSetUp makes.
struct SetUp {
  reduce::FactoredBody body;  ///< K and M are references, or AIJ copies of other types
  VelocityForces velocity;    ///< C likewise, or nothing
};

/// Masters in the user's order, then the modes.
struct Result {
  reduce::Reduction reduction;
  std::vector<PetscReal> f_Hz;  ///< [k] of the certified modes
  CMSQuality quality;
  /// Made when asked for; C_r only with damping, T_y only of a harmonic with two phases.
  petsc::Matrix K_r = {}, M_r = {}, C_r = {}, T = {}, T_y = {};
};

/// What the user has said.
struct Settings {
  reduce::ReductionOptions options{.basis = {.method = reduce::Method::craig_bampton, .modes = 20}};
  CMSMonitorFunction monitor = nullptr;
  void* monitor_context = nullptr;
  CMSProgressFunction progress = nullptr;
  void* progress_context = nullptr;
  bool prints_phases = false;
};

/// All that a CMS holds.
struct Inside {
  petsc::Matrix K, M, C;                    ///< as given
  petsc::IndexSet interface, held, output;  ///< as given
  std::vector<MasterPlace> geometry;        ///< of this rank's part of the interface, or empty
  std::optional<Sectors> sectors;           ///< as given
  PetscInt harmonic = 0;
  Settings settings;
  std::optional<HarmonicProblem> problem;  ///< of sectors
  std::optional<SetUp> set_up;
  std::optional<Result> result;
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

/// Brackets a phase: log event, wall time, monitor, and how much of it is done meanwhile; with
/// -cms_monitor on a terminal also how long the rest will take.
class Phase {
 public:
  Phase(CMS cms, PetscLogEvent event, std::string name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;
  /// Calls the monitor; left out when an exception ends the phase.
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
  int users_code_ = 0;  ///< that the progress function returned on this rank
  std::optional<linear::ListenToProgress> listener_;
};

/// Makes phases of a CMS of those of a reduction; short ones have none of their own.
class CMSPhases : public reduce::PhaseListener {
 public:
  explicit CMSPhases(CMS cms) : cms_(cms) {}

 private:
  void begun(const std::string& name) override;
  void ended() override;

  CMS cms_;
  std::optional<Phase> phase_;
};

/// Where the solvers inside find the options of the object: `-PREFIXcms_...` in its own database.
linear::OptionSource option_source(CMS cms);

/// @throws chladni::Error on all ranks when the operators or the interface cannot be reduced.
SetUp make_set_up(CMS cms);
/// The harmonic of the sectors, made where there is none.
HarmonicProblem& made_problem(CMS cms);
Result make_result(CMS cms);
/// What CMSSetHeld was given, the same on every rank.
/// @note   Collective.
std::vector<PetscInt> held_masters(const Inside& inside);
/// T, of a harmonic also T_y, with the rows asked for.
void make_transformation(Inside& in);
/// T^T C T; masters ascending by DOF. Symmetric where C is.
Eigen::MatrixXd reduced_velocity_forces(const Inside& in);
void write_file(CMS cms, const std::string& path);

}  // namespace chladni::plugin

struct _CMSOps {};

/// The object that the C header hides.
struct _p_CMS {
  PETSCHEADER(struct _CMSOps);
  chladni::plugin::Inside* inside;
};
