// The functions of FMI 2.0 that model exchange and co-simulation share, by the names of its
// standard.
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
