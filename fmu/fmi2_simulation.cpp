// The functions of FMI 2.0 for model exchange and for co-simulation, by the names of its standard.
#include "fmu/fmi2.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "fmu/component.hpp"

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi2;
using chladni::Error;

}  // namespace

extern "C" {

Status fmi2EnterEventMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi2NewDiscreteStates(void* c, EventInfo* info)
{
  return done<Status>(c, [&](Simulation&) { *info = {}; });
}

Status fmi2EnterContinuousTimeMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi2CompletedIntegratorStep(void* c, Boolean /*no_earlier_state*/, Boolean* enter_event_mode,
                                   Boolean* terminate)
{
  return done<Status>(c, [&](Simulation&) { *enter_event_mode = *terminate = 0; });
}

Status fmi2SetTime(void* c, double time)
{
  return done<Status>(c, [&](Simulation& simulation) { simulation.set_time(time); });
}

Status fmi2SetContinuousStates(void* c, const double* x, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    simulation.set_continuous_states(Eigen::Map<const Eigen::VectorXd>(x, Eigen::Index(n)));
  });
}

Status fmi2GetDerivatives(void* c, double* derivatives, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::ranges::copy(simulation.derivatives(), derivatives);
  });
}

Status fmi2GetEventIndicators(void* c, double*, std::size_t n)
{
  return done<Status>(c, [&](Simulation&) {
    if (n > 0) throw Error("the FMU has no event indicators");
  });
}

Status fmi2GetContinuousStates(void* c, double* x, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::ranges::copy(simulation.continuous_states(), x);
  });
}

Status fmi2GetNominalsOfContinuousStates(void* c, double* nominals, std::size_t n)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_states(simulation, n);
    std::fill_n(nominals, n, 1.0);
  });
}

Status fmi2SetRealInputDerivatives(void* c, const Reference*, std::size_t, const int*,
                                   const double*)
{
  return not_provided<Status>(c, "fmi2SetRealInputDerivatives");
}

Status fmi2GetRealOutputDerivatives(void* c, const Reference*, std::size_t, const int*, double*)
{
  return not_provided<Status>(c, "fmi2GetRealOutputDerivatives");
}

Status fmi2DoStep(void* c, double time, double step, Boolean /*no_earlier_state*/)
{
  return done<Status>(c, [&](Simulation& simulation) {
    simulation.set_time(time);
    simulation.advance(step);
  });
}

Status fmi2CancelStep(void* c)
{
  return not_provided<Status>(c, "fmi2CancelStep");
}

Status fmi2GetStatus(void* c, StatusKind /*kind*/, Status*)
{
  return done<Status>(c, [](Simulation&) {}) == Status::ok ? Status::discard : Status::error;
}

Status fmi2GetRealStatus(void* c, StatusKind kind, double* value)
{
  if (kind != last_successful_time) return fmi2GetStatus(c, kind, nullptr);
  return done<Status>(c, [&](Simulation& simulation) { *value = simulation.time(); });
}

Status fmi2GetIntegerStatus(void* c, StatusKind kind, int*)
{
  return fmi2GetStatus(c, kind, nullptr);
}

Status fmi2GetBooleanStatus(void* c, StatusKind kind, Boolean* value)
{
  if (kind != terminated) return fmi2GetStatus(c, kind, nullptr);
  return done<Status>(c, [&](Simulation&) { *value = 0; });
}

Status fmi2GetStringStatus(void* c, StatusKind kind, const char**)
{
  return fmi2GetStatus(c, kind, nullptr);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
