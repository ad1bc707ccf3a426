#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// The events that -log_view distinguishes within the phases of a reduction.
enum class Event { ordering, analysis, factorization, solution, sparse_product, orthogonalization };

/// Records time and memory traffic of its scope under one of PETSc's log events.
class LogEvent {
 public:
  explicit LogEvent(Event event);
  ~LogEvent();
  LogEvent(const LogEvent&) = delete;
  LogEvent& operator=(const LogEvent&) = delete;

 private:
  PetscLogEvent event_;
};

/// Adds floating-point operations for -log_view.
inline void log_operations(double n)
{
  PetscLogFlops(n);
}

}  // namespace chladni::linear
