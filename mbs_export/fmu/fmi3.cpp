// The functions of FMI 3.0 that its kinds of simulation share, by the names of its standard.

#include "mbs_export/fmu/fmi3.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "mbs_export/fmu/component.hpp"

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi3;
using chladni::Error;

/// All variables are scalars.
void check_sizes(std::size_t n_references, std::size_t n_values)
{
  if (n_references != n_values) {
    throw Error(std::to_string(n_references) + " scalar variables and " + std::to_string(n_values) +
                " values");
  }
}

void* instantiated(const char* token, const char* resources, void* environment,
                   LogMessage log_message)
{
  std::function<void(const std::string&)> tell;
  if (log_message != nullptr) {
    tell = [=](const std::string& message) {
      log_message(environment, Status::error, "logStatusError", message.c_str());
    };
  }
  Component* made = nullptr;
  succeeds(tell, [&] {
    if (token == nullptr || resources == nullptr)
      throw Error("an FMU needs the instantiation token and the path of its resources");
    made = new Component{.simulation = simulation_at(resources, token), .tell = tell};
  });
  return made;
}

}  // namespace

extern "C" {

const char* fmi3GetVersion()
{
  return "3.0";
}

Status fmi3SetDebugLogging(void* c, bool /*on*/, std::size_t /*n*/,
                           const char* const* /*categories*/)
{
  return done<Status>(c, [](Simulation&) {});
}

void* fmi3InstantiateModelExchange(const char* /*name*/, const char* token, const char* resources,
                                   bool /*visible*/, bool /*logging*/, void* environment,
                                   LogMessage log_message)
{
  return instantiated(token, resources, environment, log_message);
}

void* fmi3InstantiateCoSimulation(const char* /*name*/, const char* token, const char* resources,
                                  bool /*visible*/, bool /*logging*/, bool /*event_mode_used*/,
                                  bool /*early_return_allowed*/,
                                  const Reference* /*intermediate_variables*/,
                                  std::size_t /*n_intermediate_variables*/, void* environment,
                                  LogMessage log_message, IntermediateUpdate /*update*/)
{
  return instantiated(token, resources, environment, log_message);
}

void* fmi3InstantiateScheduledExecution(const char*, const char*, const char*, bool, bool,
                                        void* environment, LogMessage log_message, void (*)(void*),
                                        void (*)(), void (*)())
{
  if (log_message != nullptr) {
    log_message(environment, Status::error, "logStatusError",
                "this FMU is for model exchange and co-simulation, not for scheduled execution");
  }
  return nullptr;
}

void fmi3FreeInstance(void* c)
{
  delete static_cast<Component*>(c);
}

Status fmi3EnterInitializationMode(void* c, bool /*has_tolerance*/, double /*tolerance*/,
                                   double start_time, bool /*has_stop*/, double /*stop*/)
{
  return done<Status>(c, [&](Simulation& simulation) { simulation.set_time(start_time); });
}

Status fmi3ExitInitializationMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3Terminate(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi3Reset(void* c)
{
  return done<Status>(c, [](Simulation& simulation) { simulation.reset(); });
}

Status fmi3GetFloat64(void* c, const Reference* references, std::size_t n, double* values,
                      std::size_t n_values)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_sizes(n, n_values);
    std::ranges::copy(simulation.values({references, n}), values);
  });
}

Status fmi3SetFloat64(void* c, const Reference* references, std::size_t n, const double* values,
                      std::size_t n_values)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_sizes(n, n_values);
    for (std::size_t i = 0; i < n; ++i) simulation.set_value(references[i], values[i]);
  });
}

Status fmi3GetNumberOfVariableDependencies(void* c, Reference, std::size_t*)
{
  return not_provided<Status>(c, "fmi3GetNumberOfVariableDependencies");
}

Status fmi3GetVariableDependencies(void* c, Reference, std::size_t*, Reference*, std::size_t*,
                                   DependencyKind*, std::size_t)
{
  return not_provided<Status>(c, "fmi3GetVariableDependencies");
}

Status fmi3GetFMUState(void* c, void** state)
{
  return done<Status>(c, [&](Simulation& simulation) { keep_state(simulation, state); });
}

Status fmi3SetFMUState(void* c, void* state)
{
  return done<Status>(c, [&](Simulation& simulation) {
    simulation.restore(*static_cast<Eigen::VectorXd*>(state));
  });
}

Status fmi3FreeFMUState(void* c, void** state)
{
  return done<Status>(c, [&](Simulation&) {
    if (state == nullptr) return;
    delete static_cast<Eigen::VectorXd*>(*state);
    *state = nullptr;
  });
}

Status fmi3SerializedFMUStateSize(void* c, void*, std::size_t* size)
{
  return done<Status>(c, [&](Simulation& simulation) { *size = size_of_state(simulation); });
}

Status fmi3SerializeFMUState(void* c, void* state, std::uint8_t* bytes, std::size_t size)
{
  return done<Status>(
      c, [&](Simulation& simulation) { state_to_bytes(simulation, state, bytes, size); });
}

Status fmi3DeserializeFMUState(void* c, const std::uint8_t* bytes, std::size_t size, void** state)
{
  return done<Status>(
      c, [&](Simulation& simulation) { *state = state_from_bytes(simulation, bytes, size); });
}

Status fmi3GetDirectionalDerivative(void* c, const Reference* unknowns, std::size_t n_unknowns,
                                    const Reference* knowns, std::size_t n_knowns,
                                    const double* seed, std::size_t n_seed, double* sensitivity,
                                    std::size_t n_sensitivity)
{
  return done<Status>(c, [&](Simulation& simulation) {
    check_sizes(n_knowns, n_seed);
    check_sizes(n_unknowns, n_sensitivity);
    std::ranges::copy(simulation.directional_derivatives({unknowns, n_unknowns},
                                                         {{knowns, n_knowns}, {seed, n_knowns}}),
                      sensitivity);
  });
}

Status fmi3GetAdjointDerivative(void* c, const Reference*, std::size_t, const Reference*,
                                std::size_t, const double*, std::size_t, double*, std::size_t)
{
  return not_provided<Status>(c, "fmi3GetAdjointDerivative");
}

Status fmi3EnterConfigurationMode(void* c)
{
  return not_provided<Status>(c, "fmi3EnterConfigurationMode");
}

Status fmi3ExitConfigurationMode(void* c)
{
  return not_provided<Status>(c, "fmi3ExitConfigurationMode");
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)

// Getters and setters of FMI 3.0 for types and clocks that no variable has, by the names of its
// standard.

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi3;
using chladni::Error;

}  // namespace

extern "C" {

Status fmi3GetFloat32(void* c, const Reference*, std::size_t n, float*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetFloat32(void* c, const Reference*, std::size_t n, const float*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt8(void* c, const Reference*, std::size_t n, std::int8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt8(void* c, const Reference*, std::size_t n, const std::int8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt8(void* c, const Reference*, std::size_t n, std::uint8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt8(void* c, const Reference*, std::size_t n, const std::uint8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt16(void* c, const Reference*, std::size_t n, std::int16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt16(void* c, const Reference*, std::size_t n, const std::int16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt16(void* c, const Reference*, std::size_t n, std::uint16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt16(void* c, const Reference*, std::size_t n, const std::uint16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt32(void* c, const Reference*, std::size_t n, std::int32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt32(void* c, const Reference*, std::size_t n, const std::int32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt32(void* c, const Reference*, std::size_t n, std::uint32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt32(void* c, const Reference*, std::size_t n, const std::uint32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt64(void* c, const Reference*, std::size_t n, std::int64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt64(void* c, const Reference*, std::size_t n, const std::int64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt64(void* c, const Reference*, std::size_t n, std::uint64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt64(void* c, const Reference*, std::size_t n, const std::uint64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetBoolean(void* c, const Reference*, std::size_t n, bool*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetBoolean(void* c, const Reference*, std::size_t n, const bool*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetString(void* c, const Reference*, std::size_t n, const char**, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetString(void* c, const Reference*, std::size_t n, const char* const*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetBinary(void* c, const Reference*, std::size_t n, std::size_t*, const std::uint8_t**,
                     std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetBinary(void* c, const Reference*, std::size_t n, const std::size_t*,
                     const std::uint8_t* const*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetClock(void* c, const Reference*, std::size_t n, bool*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetClock(void* c, const Reference*, std::size_t n, const bool*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetIntervalDecimal(void* c, const Reference*, std::size_t n, double*, IntervalQualifier*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetIntervalFraction(void* c, const Reference*, std::size_t n, std::uint64_t*,
                               std::uint64_t*, IntervalQualifier*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetShiftDecimal(void* c, const Reference*, std::size_t n, double*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetShiftFraction(void* c, const Reference*, std::size_t n, std::uint64_t*,
                            std::uint64_t*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetIntervalDecimal(void* c, const Reference*, std::size_t n, const double*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetIntervalFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                               const std::uint64_t*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetShiftDecimal(void* c, const Reference*, std::size_t n, const double*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetShiftFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                            const std::uint64_t*)
{
  return none_of<Status>(c, n);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)

// The functions of FMI 3.0 for model exchange and for co-simulation, by the names of its standard.

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
