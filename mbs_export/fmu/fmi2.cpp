// The functions of FMI 2.0 that model exchange and co-simulation share, by the names of its
// standard.

#include "mbs_export/fmu/fmi2.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "mbs_export/fmu/component.hpp"

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi2;
using chladni::Error;

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform()
{
  return "default";
}

const char* fmi2GetVersion()
{
  return "2.0";
}

Status fmi2SetDebugLogging(void* c, Boolean /*on*/, std::size_t /*n*/,
                           const char* const* /*categories*/)
{
  return done<Status>(c, [](Simulation&) {});
}

void* fmi2Instantiate(const char* name, Type /*type*/, const char* guid, const char* resources,
                      const CallbackFunctions* functions, Boolean /*visible*/, Boolean /*logging*/)
{
  const std::string told_name = name != nullptr ? name : "";
  std::function<void(const std::string&)> tell;
  if (functions != nullptr && functions->logger != nullptr) {
    tell = [told_name, logger = functions->logger,
            environment = functions->environment](const std::string& message) {
      logger(environment, told_name.c_str(), Status::error, "logStatusError", "%s",
             message.c_str());
    };
  }
  Component* made = nullptr;
  succeeds(tell, [&] {
    if (guid == nullptr || resources == nullptr)
      throw Error("fmi2Instantiate needs the GUID and the location of the resources");
    made = new Component{.simulation = simulation_at(resources, guid), .tell = tell};
  });
  return made;
}

void fmi2FreeInstance(void* c)
{
  delete static_cast<Component*>(c);
}

Status fmi2SetupExperiment(void* c, Boolean /*has_tolerance*/, double /*tolerance*/,
                           double start_time, Boolean /*has_stop*/, double /*stop*/)
{
  return done<Status>(c, [&](Simulation& simulation) { simulation.set_time(start_time); });
}

Status fmi2EnterInitializationMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi2ExitInitializationMode(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi2Terminate(void* c)
{
  return done<Status>(c, [](Simulation&) {});
}

Status fmi2Reset(void* c)
{
  return done<Status>(c, [](Simulation& simulation) { simulation.reset(); });
}

Status fmi2GetReal(void* c, const Reference* references, std::size_t n, double* values)
{
  return done<Status>(c, [&](Simulation& simulation) {
    std::ranges::copy(simulation.values({references, n}), values);
  });
}

Status fmi2SetReal(void* c, const Reference* references, std::size_t n, const double* values)
{
  return done<Status>(c, [&](Simulation& simulation) {
    for (std::size_t i = 0; i < n; ++i) simulation.set_value(references[i], values[i]);
  });
}

Status fmi2GetInteger(void* c, const Reference*, std::size_t n, int*)
{
  return none_of<Status>(c, n);
}

Status fmi2GetBoolean(void* c, const Reference*, std::size_t n, Boolean*)
{
  return none_of<Status>(c, n);
}

Status fmi2GetString(void* c, const Reference*, std::size_t n, const char**)
{
  return none_of<Status>(c, n);
}

Status fmi2SetInteger(void* c, const Reference*, std::size_t n, const int*)
{
  return none_of<Status>(c, n);
}

Status fmi2SetBoolean(void* c, const Reference*, std::size_t n, const Boolean*)
{
  return none_of<Status>(c, n);
}

Status fmi2SetString(void* c, const Reference*, std::size_t n, const char* const*)
{
  return none_of<Status>(c, n);
}

Status fmi2GetFMUstate(void* c, void** state)
{
  return done<Status>(c, [&](Simulation& simulation) { keep_state(simulation, state); });
}

Status fmi2SetFMUstate(void* c, void* state)
{
  return done<Status>(c, [&](Simulation& simulation) {
    simulation.restore(*static_cast<Eigen::VectorXd*>(state));
  });
}

Status fmi2FreeFMUstate(void* c, void** state)
{
  return done<Status>(c, [&](Simulation&) {
    if (state == nullptr) return;
    delete static_cast<Eigen::VectorXd*>(*state);
    *state = nullptr;
  });
}

Status fmi2SerializedFMUstateSize(void* c, void*, std::size_t* size)
{
  return done<Status>(c, [&](Simulation& simulation) { *size = size_of_state(simulation); });
}

Status fmi2SerializeFMUstate(void* c, void* state, char* bytes, std::size_t size)
{
  return done<Status>(
      c, [&](Simulation& simulation) { state_to_bytes(simulation, state, bytes, size); });
}

Status fmi2DeSerializeFMUstate(void* c, const char* bytes, std::size_t size, void** state)
{
  return done<Status>(
      c, [&](Simulation& simulation) { *state = state_from_bytes(simulation, bytes, size); });
}

Status fmi2GetDirectionalDerivative(void* c, const Reference* unknowns, std::size_t n_unknowns,
                                    const Reference* knowns, std::size_t n_knowns,
                                    const double* change, double* derivatives)
{
  return done<Status>(c, [&](Simulation& simulation) {
    std::ranges::copy(simulation.directional_derivatives({unknowns, n_unknowns},
                                                         {{knowns, n_knowns}, {change, n_knowns}}),
                      derivatives);
  });
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)

// The functions of FMI 2.0 for model exchange and for co-simulation, by the names of its standard.

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
