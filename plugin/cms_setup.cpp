// CMSSetUp: checks, partition, factor of K_ss.
#include <algorithm>
#include <numeric>

#include "plugin/check_operators.hpp"
#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

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
