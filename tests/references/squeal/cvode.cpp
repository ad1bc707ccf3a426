#include "tests/references/squeal/cvode.hpp"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <memory>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

void check(int flag, const char* what)
{
  if (flag < 0) throw Error(fmt::format("{} failed: {}", what, flag));
}

#ifdef SUN_COMM_NULL
const SUNComm no_communicator = SUN_COMM_NULL;
#else
void* const no_communicator = nullptr;  // before SUNDIALS 7
#endif

int rate(sunrealtype t, N_Vector y, N_Vector f, void* data)
{
  auto& motion = *static_cast<Motion*>(data);
  const Eigen::Index n = 2 * motion.omega().size();
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), n);
  Eigen::Map<Eigen::VectorXd> result(N_VGetArrayPointer(f), n);
  result = motion.rate(t, at);
  bool changed = false;
  for (Eigen::Index i = 0; i < motion.switches().size(); ++i) {
    const double side = motion.switches()[i] < 0.0 ? -1.0 : 1.0;
    changed = changed || side != motion.side(i);
    motion.set_side(i, side);
  }
  if (changed) result = motion.rate(t, at);
  return 0;
}

/// Frees what SUNDIALS allocates.
template <class Type>
using Owned = std::unique_ptr<std::remove_pointer_t<Type>, void (*)(Type)>;

}  // namespace

const bool has_cvode = true;

Eigen::VectorXd cvode(Motion& motion, const Eigen::VectorXd& y, double duration, double tolerance,
                      CvodeMethod method)
{
  SUNContext context = nullptr;
  check(SUNContext_Create(no_communicator, &context), "SUNContext_Create");
  const std::unique_ptr<SUNContext, void (*)(SUNContext*)> context_owner(
      &context, [](SUNContext* c) { SUNContext_Free(c); });
  Eigen::VectorXd state = y;
  const Owned<N_Vector> x(N_VMake_Serial(state.size(), state.data(), context), N_VDestroy);
  const std::unique_ptr<void, void (*)(void*)> solver(
      CVodeCreate(method == CvodeMethod::adams ? CV_ADAMS : CV_BDF, context),
      [](void* memory) { CVodeFree(&memory); });
  check(CVodeInit(solver.get(), rate, 0.0, x.get()), "CVodeInit");
  check(CVodeSStolerances(solver.get(), tolerance, tolerance * y.norm()), "CVodeSStolerances");
  check(CVodeSetUserData(solver.get(), &motion), "CVodeSetUserData");
  check(CVodeSetMaxNumSteps(solver.get(), 100000000), "CVodeSetMaxNumSteps");
  check(CVodeSetStopTime(solver.get(), duration), "CVodeSetStopTime");
  const Owned<SUNNonlinearSolver> fixed_point(SUNNonlinSol_FixedPoint(x.get(), 0, context),
                                              [](SUNNonlinearSolver s) { SUNNonlinSolFree(s); });
  const Owned<SUNMatrix> matrix(SUNDenseMatrix(state.size(), state.size(), context), SUNMatDestroy);
  const Owned<SUNLinearSolver> linear(SUNLinSol_Dense(x.get(), matrix.get(), context),
                                      [](SUNLinearSolver s) { SUNLinSolFree(s); });
  if (method == CvodeMethod::adams)
    check(CVodeSetNonlinearSolver(solver.get(), fixed_point.get()), "CVodeSetNonlinearSolver");
  else
    check(CVodeSetLinearSolver(solver.get(), linear.get(), matrix.get()), "CVodeSetLinearSolver");
  double t = 0.0;
  check(CVode(solver.get(), duration, x.get(), &t, CV_NORMAL), "CVode");
  return state;
}

}  // namespace chladni::squeal
