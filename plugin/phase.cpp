// Phases of a CMS: log events, -cms_monitor and progress.
#include <fmt/format.h>
#include <petsctime.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

namespace chladni::plugin {

namespace {

constexpr const char* wipe_line = "\r\033[K";

PetscErrorCode print_phase(CMS cms, const char phase[], PetscReal seconds)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PetscObjectComm((PetscObject)cms), "  CMS %-24s %10.3f s\n", phase,
                        (double)seconds));
  PetscFunctionReturn(0);
}

std::string progress_failure(int code, const std::string& phase)
{
  return fmt::format("the function of CMSProgressSet() returned error {} in the phase \"{}\"", code,
                     phase);
}

}  // namespace

Phase::Phase(CMS cms, PetscLogEvent event, std::string name)
    : cms_(cms), event_(event), name_(std::move(name))
{
  petsc::check(PetscLogEventBegin(event_, cms_, 0, 0, 0));
  petsc::check(PetscTime(&started_));
  listen();
}

void Phase::listen()
{
  const Settings& settings = cms_->inside->settings;
  const bool is_first = petsc::rank(PetscObjectComm(reinterpret_cast<PetscObject>(cms_))) == 0;
  const bool is_shown = settings.prints_phases && is_first && isatty(STDERR_FILENO) != 0;
  if (!is_shown && !settings.progress) return;
  listener_.emplace([this, is_shown](double fraction) {
    if (is_shown) show(fraction);
    tell(fraction);
  });
}

Phase::~Phase()
{
  if (shown_ > 0.0) std::fputs(wipe_line, stderr);
  static_cast<void>(PetscLogEventEnd(event_, cms_, 0, 0, 0));
}

/// "  CMS fixed-interface modes: 42 %, 7 s left", twice a second from the third second on.
void Phase::show(double fraction)
{
  PetscLogDouble now = 0.0;
  constexpr double short_s = 2.0, pause_s = 0.5;
  if (PetscTime(&now) != 0 || now - started_ < short_s || now - shown_ < pause_s) return;
  shown_ = now;
  const double left_s = fraction > 0.0 ? (now - started_) * (1.0 - fraction) / fraction : 0.0;
  std::fputs(
      fmt::format("{}  CMS {}: {:.0f} %, {:.0f} s left", wipe_line, name_, 100.0 * fraction, left_s)
          .c_str(),
      stderr);
}

/// Where there are other ranks, they hear of a failure at the end of the phase only: until then
/// they wait for this one.
void Phase::tell(double fraction)
{
  const Settings& settings = cms_->inside->settings;
  if (!settings.progress || users_code_ != 0) return;
  users_code_ = settings.progress(cms_, name_.c_str(), fraction, settings.progress_context);
  if (users_code_ == 0 || petsc::size(PetscObjectComm(reinterpret_cast<PetscObject>(cms_))) > 1)
    return;
  throw UsersFailure(static_cast<PetscErrorCode>(users_code_),
                     progress_failure(users_code_, name_));
}

void Phase::done()
{
  PetscLogDouble now = 0.0;
  petsc::check(PetscTime(&now));
  const Settings& settings = cms_->inside->settings;
  if (settings.prints_phases) petsc::check(print_phase(cms_, name_.c_str(), now - started_));
  if (settings.monitor || settings.progress) call_monitor(now - started_);
}

/// The user's functions are called on all ranks and may fail on one.
void Phase::call_monitor(PetscLogDouble seconds)
{
  const Settings& settings = cms_->inside->settings;
  std::array<int, 2> codes{0, users_code_};
  if (settings.monitor)
    codes[0] = settings.monitor(cms_, name_.c_str(), seconds, settings.monitor_context);
  MPI_Allreduce(MPI_IN_PLACE, codes.data(), 2, MPI_INT, MPI_MAX,
                PetscObjectComm(reinterpret_cast<PetscObject>(cms_)));
  if (codes[0] != 0) {
    throw UsersFailure(
        static_cast<PetscErrorCode>(codes[0]),
        fmt::format(
            "the monitor of CMSMonitorSet() returned error {} at the end of the phase \"{}\"",
            codes[0], name_));
  }
  if (codes[1] != 0)
    throw UsersFailure(static_cast<PetscErrorCode>(codes[1]), progress_failure(codes[1], name_));
}

namespace {

struct EventOfPhase {
  std::string_view phase;
  PetscLogEvent Events::*event;
};

constexpr std::array events_of_phases{
    EventOfPhase{"factorization", &Events::factor},
    EventOfPhase{"constraint modes", &Events::constraint},
    EventOfPhase{"fixed-interface modes", &Events::modes},
    EventOfPhase{"choice of modes", &Events::errors},
    EventOfPhase{"free-interface modes", &Events::modes},
    EventOfPhase{"residual flexibility", &Events::modes},
    EventOfPhase{"mass of the modes", &Events::modes},
    EventOfPhase{"projection", &Events::project},
    EventOfPhase{"error estimates", &Events::errors},
    EventOfPhase{"count of eigenvalues", &Events::count},
};

}  // namespace

void CMSPhases::begun(const std::string& name)
{
  const auto* const found = std::ranges::find(events_of_phases, name, &EventOfPhase::phase);
  if (found != events_of_phases.end()) phase_.emplace(cms_, events.*(found->event), name);
}

void CMSPhases::ended()
{
  if (phase_) phase_->done();
  phase_.reset();
}

}  // namespace chladni::plugin
