#pragma once

#include <functional>
#include <string>

#include "common/error.hpp"
#include "mbs_export/fmu/simulation.hpp"

namespace chladni::fmu {

/// An FMU component for both versions of FMI: the simulation, and the function that logs errors.
struct Component {
  std::unique_ptr<Simulation> simulation;
  std::function<void(const std::string&)> tell;
};

/// The bytes of a file among the resources of an FMU.
/// @param location  a path, or a URI with the scheme "file"
/// @throws chladni::Error when the file cannot be opened.
std::string resource(const std::string& location, const std::string& file);

/// Checks that the model and modelDescription.xml come from the same export.
/// @throws chladni::Error when their tokens differ.
void check_token(const std::string& of_model, const std::string& of_description);

/// Calls action(); an exception is logged by `tell` and not passed on.
/// @return whether `action` ended without an exception
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

/// Calls action(simulation) for an FMI function and returns its status: `error` when there is no
/// component or `action` threw, which is logged.
template <class Status>
Status done(void* component, auto&& action) noexcept
{
  if (component == nullptr) return Status::error;
  auto& self = *static_cast<Component*>(component);
  return succeeds(self.tell, [&] { action(*self.simulation); }) ? Status::ok : Status::error;
}

/// Status of an FMI getter or setter for a type of variables that this FMU does not have: `ok` for
/// n = 0, else `error`.
template <class Status>
Status none_of(void* component, std::size_t n) noexcept
{
  return done<Status>(component, [&](Simulation&) {
    if (n > 0) throw Error("all variables of this FMU are real numbers of 64 bits");
  });
}

/// Status `error` of an FMI function that this FMU does not provide, and logs it.
/// @param what  name of the function
template <class Status>
Status not_provided(void* component, const char* what) noexcept
{
  return done<Status>(component,
                      [&](Simulation&) { throw Error(std::string(what) + " is not provided"); });
}

/// Checks the number of continuous states.
/// @throws chladni::Error unless the FMU has n of them.
void check_states(const Simulation& simulation, std::size_t n);

/// Stores a snapshot of the simulation in `*state`, an Eigen::VectorXd; allocates it when `*state`
/// is null.
void keep_state(const Simulation& simulation, void** state);

/// Converts a snapshot to bytes and back.
/// @throws chladni::Error when the buffer is too small, or the bytes are of another FMU or not
///         finite.
std::size_t size_of_state(const Simulation& simulation);
void state_to_bytes(const Simulation& simulation, const void* state, void* bytes, std::size_t n);
void* state_from_bytes(const Simulation& simulation, const void* bytes, std::size_t n);

}  // namespace chladni::fmu
