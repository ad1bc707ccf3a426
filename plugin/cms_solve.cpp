// CMSSetUp: checks, partition, factor of K_ss.

#include <fmt/format.h>
#include <petsctime.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

#include "plugin/cms_impl.hpp"
#include "plugin/cms_operators.hpp"
#include "reduce/support.hpp"

namespace chladni::plugin {

namespace {

/// Ascending; out-of-range and double ones are refused by value.
std::vector<PetscInt> checked_ascending(std::vector<PetscInt> masters, PetscInt n)
{
  std::ranges::sort(masters);
  if (masters.empty() || std::ssize(masters) >= n) {
    throw Error(
        fmt::format("CMSSetInterface: {} masters of {} rows; give at least one and leave "
                    "at least one slave",
                    masters.size(), n));
  }
  if (masters.front() < 0 || masters.back() >= n) {
    throw Error(fmt::format("CMSSetInterface: master {} is out of range; rows are 0 to {}",
                            masters.front() < 0 ? masters.front() : masters.back(), n - 1));
  }
  const auto twin = std::ranges::adjacent_find(masters);
  if (twin != masters.end())
    throw Error(fmt::format("CMSSetInterface: master {} is given twice", *twin));
  return masters;
}

Operators checked_operators(CMS cms)
{
  Phase phase(cms, events.check, "checks of the input");
  const Inside& in = *cms->inside;
  if (!in.K || !in.M) throw Error("CMSSetUp: no operators; call CMSSetOperators() first");
  Operators checked{.K = checked_operator(in.K, in.K, "K"),
                    .M = checked_operator(in.M, in.K, "M"),
                    .velocity = {.C = {}, .is_symmetric = true}};
  if (in.C) checked.velocity = checked_velocity_forces(in.C, in.K);
  phase.done();
  return checked;
}

/// References to what is reduced: of sectors a harmonic, else what was given.
Operators reduced_operators(CMS cms)
{
  if (!cms->inside->sectors) {
    if (const PetscInt n = cms->inside->harmonic; n != 0) {
      throw Error(
          fmt::format("CMSSetHarmonic: harmonic {} without sectors; call CMSSetCyclic(), or leave "
                      "-cms_harmonic out",
                      n));
    }
    return checked_operators(cms);
  }
  const Operators& made = made_problem(cms).operators;
  return {.K = reference<petsc::Matrix>(static_cast<Mat>(made.K)),
          .M = reference<petsc::Matrix>(static_cast<Mat>(made.M)),
          .velocity = {.C = reference<petsc::Matrix>(static_cast<Mat>(made.velocity.C)),
                       .is_symmetric = made.velocity.is_symmetric}};
}

/// The rows that are kept, in the order of the reduced rows.
std::vector<PetscInt> reduced_masters(Inside& in)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(in.K, &n, nullptr));
  std::vector<PetscInt> masters = all_indices(in.interface);
  checked_ascending(masters, n);
  if (!in.problem) return masters;
  in.problem->masters = harmonic_masters(in.problem->harmonic.coordinates, masters);
  return in.problem->masters.coordinates;
}

std::vector<PetscInt> ascending(std::vector<PetscInt> rows)
{
  std::ranges::sort(rows);
  return rows;
}

}  // namespace

std::vector<PetscInt> held_masters(const Inside& inside)
{
  if (!inside.held) return {};
  std::vector<PetscInt> held = all_indices(inside.held);
  if (!inside.problem) return held;
  return harmonic_masters(inside.problem->harmonic.coordinates, held).coordinates;
}

HarmonicProblem& made_problem(CMS cms)
{
  Inside& in = *cms->inside;
  if (!in.sectors) throw Error("no sectors; call CMSSetCyclic() first");
  if (!in.problem) {
    const Operators sector = checked_operators(cms);
    Phase phase(cms, events.harmonic, "harmonic matrices");
    in.problem = harmonic_problem(*in.sectors, in.harmonic, sector);
    phase.done();
  }
  return *in.problem;
}

SetUp make_set_up(CMS cms)
{
  Inside& in = *cms->inside;
  Operators made = reduced_operators(cms);
  if (!in.interface) throw Error("CMSSetUp: no interface; call CMSSetInterface() first");
  std::vector<PetscInt> masters = reduced_masters(in);
  NameOfRow name_of_row;
  if (in.problem) {
    name_of_row = [&coordinates = in.problem->harmonic.coordinates](PetscInt coordinate) {
      return coordinates.name_of(coordinate);
    };
  }
  refuse_empty_rows(made.K, made.M, ascending(masters), name_of_row);
  reduce::ReductionOptions options = in.settings.options;
  options.solver.petsc = option_source(cms);
  CMSPhases phases(cms);
  return {.body = reduce::factored({.K = std::move(made.K),
                                    .M = std::move(made.M),
                                    .masters = std::move(masters),
                                    .name_of_dof = name_of_row,
                                    .may_lack_masters = in.problem.has_value()},
                                   options, phases),
          .velocity = std::move(made.velocity)};
}

namespace {

/// The work of CMSSetUp or CMSSolve, for as long as it lives: a stage of the log and the event that
/// spans all of it, and the mark that keeps monitors from changing the object.
class Stage {
 public:
  Stage(CMS cms, PetscLogStage stage, PetscLogEvent event) : cms_(cms), event_(event)
  {
    petsc::check(PetscLogStagePush(stage));
    petsc::check(PetscLogEventBegin(event_, cms_, 0, 0, 0));
    cms_->inside->is_at_work = true;
  }
  ~Stage()
  {
    cms_->inside->is_at_work = false;
    static_cast<void>(PetscLogEventEnd(event_, cms_, 0, 0, 0));
    static_cast<void>(PetscLogStagePop());
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  CMS cms_;
  PetscLogEvent event_;
};

}  // namespace

}  // namespace chladni::plugin

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

PetscErrorCode CMSSetUp(CMS cms)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  if (cms->inside->set_up) PetscFunctionReturn(0);
  PetscCall(refuse_at_work(cms, __func__));
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    const Stage stage(cms, events.stage_set_up, events.set_up);
    cms->inside->set_up = make_set_up(cms);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSolve(CMS cms)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(refuse_at_work(cms, __func__));
  PetscCall(CMSSetUp(cms));
  if (!cms->inside->result) {
    PetscCall(guarded((PetscObject)cms, __func__, [&] {
      const Stage stage(cms, events.stage_solve, events.solve);
      cms->inside->result = make_result(cms);
    }));
  }
  PetscCall(CMSViewFromOptions(cms, nullptr, "-cms_view"));
  PetscFunctionReturn(0);
}

namespace chladni::plugin {

// CMSSolve: the reduction, and what C programs read of its certificate.

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

CMSCount as_count(const reduce::EigenvalueCount& count)
{
  return {.upto = std::sqrt(count.sigma) / two_pi,
          .expected = count.expected,
          .found = count.found,
          .missing = count.missing()};
}

CMSQuality quality_of(const reduce::Certificate& certificate)
{
  return {.n_zero = certificate.n_zero,
          .rigid_residual = certificate.zero_energy,
          .condition = certificate.condition,
          .modes = as_count(certificate.fixed_interface),
          .model = as_count(certificate.range),
          .complete = as_count(certificate.complete)};
}

}  // namespace

Result make_result(CMS cms)
{
  CMSPhases phases(cms);
  Inside& in = *cms->inside;
  const reduce::HeldMasters support(in.set_up->body.masters, held_masters(in));
  Result result{
      .reduction = reduce::reduction(in.set_up->body, in.settings.options, support, phases),
      .f_Hz = {},
      .quality = {}};
  const reduce::Certificate& certificate = result.reduction.certificate;
  for (const double lambda : certificate.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.quality = quality_of(certificate);
  return result;
}

// Phases of a CMS: log events, -cms_monitor and progress.

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
