// The functions of FMI 3.0 for model exchange and for co-simulation, by the names of its standard.
#include "fmu/fmi3.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "fmu/component.hpp"

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi3;
using chladni::Error;

}  // namespace

extern "C" {

Status fmi3EnterEventMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3EvaluateDiscreteStates(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3UpdateDiscreteStates(void* c, bool* need_update, bool* terminate, bool* nominals_changed,
                                bool* values_changed, bool* has_next_event, double* next_event_time)
{
  return done<Status>(c, [&](Simulation&) {
    *need_update = *terminate = *nominals_changed = *values_changed = *has_next_event = false;
    *next_event_time = 0.0;
  });
}

Status fmi3EnterContinuousTimeMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3CompletedIntegratorStep(void* c, bool /*no_earlier_state*/, bool* enter_event_mode,
                                   bool* terminate)
{
  return done<Status>(c, [&](Simulation&) { *enter_event_mode = *terminate = false; });
}

Status fmi3SetTime(void* c, double time)
{
  return done<Status>(c, [&](Simulation& simulation) { simulation.set_time(time); });
}

Status fmi3SetContinuousStates(void* c, const double* x, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    simulation.set_continuous_states(Eigen::Map<const Eigen::VectorXd>(x, Eigen::Index(n)));
  });
}

Status fmi3GetContinuousStateDerivatives(void* c, double* derivatives, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::ranges::copy(simulation.derivatives(), derivatives);
  });
}

Status fmi3GetEventIndicators(void* c, double*, std::size_t n)
{
  return done<Status>(c, [&](Simulation&) {
    if (n > 0) throw Error("the FMU has no event indicators");
  });
}

Status fmi3GetContinuousStates(void* c, double* x, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::ranges::copy(simulation.continuous_states(), x);
  });
}

Status fmi3GetNominalsOfContinuousStates(void* c, double* nominals, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::fill_n(nominals, n, 1.0);
  });
}

Status fmi3GetNumberOfEventIndicators(void* c, std::size_t* n)
{
  return done<Status>(c, [&](Simulation&) { *n = 0; });
}

Status fmi3GetNumberOfContinuousStates(void* c, std::size_t* n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    *n = static_cast<std::size_t>(simulation.continuous_states().size());
  });
}

Status fmi3EnterStepMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3GetOutputDerivatives(void* c, const Reference*, std::size_t, const std::int32_t*,
                                double*, std::size_t)
{
  return not_provided<Status>(c, "fmi3GetOutputDerivatives");
}

Status fmi3DoStep(void* c, double time, double step, bool /*no_earlier_state*/,
                  bool* event_handling_needed, bool* terminate, bool* early_return,
                  double* last_successful_time)
{
  return done<Status>(c, [&](Simulation& simulation) {
    simulation.set_time(time);
    simulation.advance(step);
    *event_handling_needed = *terminate = *early_return = false;
    *last_successful_time = simulation.time();
  });
}

Status fmi3ActivateModelPartition(void* c, Reference, double)
{
  return not_provided<Status>(c, "fmi3ActivateModelPartition");
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
