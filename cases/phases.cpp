#include "cases/phases.hpp"

#include <algorithm>

#include "common/petsc.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::cases {

void Phases::begun(const std::string& name)
{
  name_ = shown_ = name;
  MPI_Pcontrol(1, name.c_str());  // to tools that count by phases
  if (!progress_) return;
  progress_(name_, 0.0);
  listener_.emplace([this](double fraction) { progress_(shown_, fraction); });
}

void Phases::show_step(const std::string& step)
{
  shown_ = step;
  if (progress_) progress_(shown_, 0.0);
}

void Phases::ended()
{
  // A page that is given back is cleared anew when the next phase touches it.
  constexpr double worth_it_MiB = 128.0;  // of all ranks, which may be on one machine
  if (linear::freed_MiB() * petsc::size(PETSC_COMM_WORLD) > worth_it_MiB) linear::give_back_freed();
  MPI_Pcontrol(0);
  listener_.reset();
  clock_.end_phase(name_);
  if (progress_) progress_(name_, 1.0);
}

const report::PhaseTime& Phases::time_of(const std::string& name) const
{
  const auto named =
      std::ranges::find(times().rbegin(), times().rend(), name, &report::PhaseTime::name);
  return *named;
}

}  // namespace chladni::cases
