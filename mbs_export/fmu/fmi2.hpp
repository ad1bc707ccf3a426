#pragma once

#include <cstddef>

/// Types of FMI 2.0 for co-simulation and model exchange, laid out as the standard requires.

namespace chladni::fmu::fmi2 {

using Boolean = int;
using Reference = unsigned int;

enum Status : int { ok, warning, discard, error, fatal, pending };
enum Type : int { model_exchange, co_simulation };
enum StatusKind : int { do_step_status, pending_status, last_successful_time, terminated };

struct CallbackFunctions {
  void (*logger)(void* environment, const char* instance, Status status, const char* category,
                 const char* message, ...);
  void* (*allocate_memory)(std::size_t n, std::size_t size);
  void (*free_memory)(void* memory);
  void (*step_finished)(void* environment, Status status);
  void* environment;
};

struct EventInfo {
  Boolean new_discrete_states_needed, terminate_simulation, nominals_changed, values_changed,
      next_event_time_defined;
  double next_event_time;
};

}  // namespace chladni::fmu::fmi2
