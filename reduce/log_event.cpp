#include "reduce/log_event.hpp"

#include <array>

namespace chladni::reduce {

namespace {

constexpr std::array names{"CMSOrdering", "CMSAnalysis", "CMSFactor",
                           "CMSSolve",    "CMSSpMM",     "CMSOrthogonal"};

using Events = std::array<PetscLogEvent, names.size()>;

Events register_events()
{
  PetscClassId class_id = 0;
  petsc::check(PetscClassIdRegister("Component mode synthesis", &class_id));
  Events events{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    petsc::check(PetscLogEventRegister(names[i], class_id, &events[i]));
  }
  return events;
}

}  // namespace

LogEvent::LogEvent(Event event)
{
  static const Events events = register_events();
  event_ = events[static_cast<std::size_t>(event)];
  petsc::check(PetscLogEventBegin(event_, 0, 0, 0, 0));
}

LogEvent::~LogEvent()
{
  PetscLogEventEnd(event_, 0, 0, 0, 0);
}

}  // namespace chladni::reduce
