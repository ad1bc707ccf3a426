#include "linear/log_event.hpp"

#include <array>
#include <optional>

namespace chladni::linear {

namespace {

constexpr std::array names{"CMSOrdering", "CMSAnalysis", "CMSFactor",
                           "CMSSolve",    "CMSSpMM",     "CMSOrthogonal"};

using Events = std::array<PetscLogEvent, names.size()>;

/// Those of this session of PETSc, which ends with PetscFinalize.
std::optional<Events> events;

void register_events()
{
  PetscClassId class_id = 0;
  petsc::check(PetscClassIdRegister("Component mode synthesis", &class_id));
  events.emplace();
  for (std::size_t i = 0; i < names.size(); ++i)
    petsc::check(PetscLogEventRegister(names[i], class_id, &(*events)[i]));
  petsc::check(PetscRegisterFinalize([]() -> PetscErrorCode {
    events.reset();
    return 0;
  }));
}

}  // namespace

LogEvent::LogEvent(Event event)
{
  if (!events) register_events();
  event_ = (*events)[static_cast<std::size_t>(event)];
  MPI_Pcontrol(2, names[static_cast<std::size_t>(event)]);  // to tools that count
  petsc::check(PetscLogEventBegin(event_, 0, 0, 0, 0));
}

LogEvent::~LogEvent()
{
  MPI_Pcontrol(3);
  PetscLogEventEnd(event_, 0, 0, 0, 0);
}

}  // namespace chladni::linear
