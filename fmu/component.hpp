#pragma once

#include <functional>
#include <string>

#include "common/error.hpp"
#include "fmu/instance.hpp"

namespace chladni::fmu {

/// What both versions of FMI share: an instance and whoever is told what was wrong.
struct Component {
  Instance instance;
  std::function<void(const std::string&)> tell;
};

/// The model of an FMU, out of the folder of its resources.
/// @param location  a path, or a URI with the scheme "file"
/// @param token     of modelDescription.xml
/// @throws chladni::Error when it cannot be read or is of another export.
ModalModel model_at(const std::string& location, const std::string& token);

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

/// What a function of FMI answers: `error` where `action`, which gets the instance, failed and has
/// been told.
template <class Status>
Status done(void* component, auto&& action) noexcept
{
  if (component == nullptr) return Status::error;
  auto& self = *static_cast<Component*>(component);
  return succeeds(self.tell, [&] { action(self.instance); }) ? Status::ok : Status::error;
}

/// Of variables of a type that this model has none of.
template <class Status>
Status none_of(void* component, std::size_t n) noexcept
{
  return done<Status>(component, [&](Instance&) {
    if (n > 0) throw Error("all variables of this FMU are real numbers of 64 bits");
  });
}

template <class Status>
Status not_provided(void* component, const char* what) noexcept
{
  return done<Status>(component,
                      [&](Instance&) { throw Error(std::string(what) + " is not provided"); });
}

/// @throws chladni::Error unless the FMU has n continuous states.
void check_states(const Instance& instance, std::size_t n);

/// A copy of what changes, in memory of its own unless `*state` has some.
void keep_state(const Instance& instance, void** state);

}  // namespace chladni::fmu
