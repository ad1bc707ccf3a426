#pragma once

#include <petsc/private/petscimpl.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reduce/condition_estimate.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/error_estimates.hpp"
#include "reduce/plugin/check_operators.hpp"
#include "reduce/plugin/chladni_cms.h"
#include "reduce/progress.hpp"
#include "reduce/reduce_options.hpp"
#include "reduce/solver_options.hpp"

/// Inside of the PETSc class CMS; nothing of it crosses the C header.
namespace chladni::reduce::plugin {

/// Where a master stands, for the file.
struct MasterPlace {
  PetscInt node;
  PetscInt component;
  double x[3];
};

/// What CMSSetUp makes.
struct SetUp {
  petsc::Matrix K, M;             ///< references, or AIJ copies of other types
  VelocityForces velocity;        ///< C likewise, or nothing
  std::vector<PetscInt> masters;  ///< global DOFs in the order of the user, on every rank
  std::vector<int> places;        ///< for each master its place among the ascending ones
  DofPartition rows;
  Blocks K_blocks, M_blocks;
  Factorization K_ss;
};

/// Masters in the user's order, then the modes.
struct Result {
  CraigBamptonBasis Q_CB;
  ReducedModel model;                ///< masters ascending by DOF
  std::vector<PetscReal> lambda;     ///< all elastic eigenvalues of the reduced model, ascending
  std::vector<PetscReal> f_Hz;       ///< [k] of the certified modes
  std::vector<PetscReal> eta2;       ///< [k]
  std::vector<PetscReal> estimates;  ///< [k] of the relative errors of f_Hz, by place
  std::vector<PetscReal> rounding;   ///< [k] of lambda, relative
  SmallMatrix residuals;             ///< [k x k] inner products, where eigenvalues are counted
  std::vector<PetscReal> bounds;     ///< [<= k] below the complete count; rounding included
  CMSQuality quality;
  petsc::Matrix K_r, M_r, C_r, T;  ///< made when asked for; C_r only with damping
};

/// What the user has said.
struct Settings {
  ReduceOptions options{.method = Method::craig_bampton, .modes = 20};
  SolverOptions solver = {};
  bool sylvester = false;
  CMSMonitorFunction monitor = nullptr;
  void* monitor_context = nullptr;
  bool prints_phases = false;
};

/// All that a CMS holds.
struct Inside {
  petsc::Matrix K, M, C;              ///< as given
  petsc::IndexSet interface, output;  ///< as given
  std::vector<MasterPlace> geometry;  ///< of this rank's part of the interface, or empty
  Settings settings;
  std::optional<SetUp> set_up;
  std::optional<Result> result;
};

struct Events {
  PetscLogEvent set_up, check, solve, factor, constraint, modes, project, errors, count, view;
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

/// Brackets a phase: log event, wall time, monitor; with -cms_monitor on a terminal also how much
/// of it is done and how long the rest will take.
class Phase {
 public:
  Phase(CMS cms, PetscLogEvent event, const char* name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;
  /// Calls the monitor; left out when an exception ends the phase.
  void done();

 private:
  void show(double fraction);
  void call_monitor(PetscLogDouble seconds);

  CMS cms_;
  PetscLogEvent event_;
  const char* name_;
  PetscLogDouble started_ = 0.0;
  PetscLogDouble shown_ = 0.0;
  std::optional<ListenToProgress> listener_;
};

/// Where the solvers inside find the options of the object: `-PREFIXcms_...` in its own database.
OptionSource option_source(CMS cms);

/// Columns of the transformation.
struct Basis {
  CraigBamptonBasis Q;
  std::optional<SmallMatrix> mass;  ///< where the method does not project it
};
Basis make_basis(CMS cms);

/// @throws chladni::Error on all ranks when the operators or the interface cannot be reduced.
SetUp make_set_up(CMS cms);
Result make_result(CMS cms);
petsc::Matrix make_transformation(CMS cms);
void write_file(CMS cms, const std::string& path);

}  // namespace chladni::reduce::plugin

struct _CMSOps {};

/// The object that the C header hides.
struct _p_CMS {
  PETSCHEADER(struct _CMSOps);
  chladni::reduce::plugin::Inside* inside;
};
