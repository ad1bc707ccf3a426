// The functions of FMI 3.0 that its kinds of simulation share, by the names of its standard.
#include "fmu/fmi3.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "fmu/component.hpp"

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
