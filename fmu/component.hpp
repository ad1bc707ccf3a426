#pragma once

#include <functional>
#include <string>

#include "common/error.hpp"
#include "fmu/simulation.hpp"

namespace chladni::fmu {

/// What both versions of FMI share: an instance and whoever is told what was wrong.
struct Component {
  std::unique_ptr<Simulation> simulation;
  std::function<void(const std::string&)> tell;
};

/// The bytes of a file among the resources of an FMU.
/// @param location  a path, or a URI with the scheme "file"
/// @throws chladni::Error when there is no such file.
std::string resource(const std::string& location, const std::string& file);

/// @throws chladni::Error unless a model has the token of modelDescription.xml.
void check_token(const std::string& of_model, const std::string& of_description);

/// Whether `action` came to its end; else what was wrong has been told.
bool succeeds(const std::function<void(const std::string&)>& tell, auto&& action) noexcept
{
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    try {
      if (tell) tell(error.what());
    } catch (...) {
    }
  } catch (...) {
  }
  return false;
}

/// What a function of FMI answers: `error` where `action`, which gets the simulation, failed and
/// has been told.
template <class Status>
Status done(void* component, auto&& action) noexcept
{
  if (component == nullptr) return Status::error;
  auto& self = *static_cast<Component*>(component);
  return succeeds(self.tell, [&] { action(*self.simulation); }) ? Status::ok : Status::error;
}

/// Of variables of a type that this model has none of.
template <class Status>
Status none_of(void* component, std::size_t n) noexcept
{
  return done<Status>(component, [&](Simulation&) {
    if (n > 0) throw Error("all variables of this FMU are real numbers of 64 bits");
  });
}

template <class Status>
Status not_provided(void* component, const char* what) noexcept
{
  return done<Status>(component,
                      [&](Simulation&) { throw Error(std::string(what) + " is not provided"); });
}

/// @throws chladni::Error unless the FMU has n continuous states.
void check_states(const Simulation& simulation, std::size_t n);

/// A copy of what changes, as Eigen::VectorXd in memory of its own unless `*state` has some.
void keep_state(const Simulation& simulation, void** state);

/// A copy of what changes as the bytes of its numbers, and back.
/// @throws chladni::Error when there is no room for it, or it is of another FMU.
std::size_t size_of_state(const Simulation& simulation);
void state_to_bytes(const Simulation& simulation, const void* state, void* bytes, std::size_t n);
void* state_from_bytes(const Simulation& simulation, const void* bytes, std::size_t n);

}  // namespace chladni::fmu
