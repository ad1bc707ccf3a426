// CMSSetUp: checks, partition, factor of K_ss.
#include <algorithm>
#include <numeric>

#include "plugin/check_operators.hpp"
#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

namespace chladni::plugin {

namespace {

/// In the order of the user, the same on every rank.
std::vector<PetscInt> indices_of_all_ranks(IS set)
{
  petsc::IndexSet gathered;
  PetscInt n = 0;
  const PetscInt* indices = nullptr;
  petsc::check(ISAllGather(set, gathered.put()));
  petsc::check(ISGetSize(gathered, &n));
  petsc::check(ISGetIndices(gathered, &indices));
  std::vector<PetscInt> all(indices, indices + n);
  petsc::check(ISRestoreIndices(gathered, &indices));
  return all;
}

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

struct Operators {
  petsc::Matrix K, M;
  VelocityForces velocity;
};

Operators checked_operators(CMS cms)
{
  Phase phase(cms, events.check, "checks of the input");
  const Inside& in = *cms->inside;
  if (!in.K || !in.M) throw Error("CMSSetUp: no operators; call CMSSetOperators() first");
  if (!in.interface) throw Error("CMSSetUp: no interface; call CMSSetInterface() first");
  Operators checked{.K = checked_operator(in.K, in.K, "K"),
                    .M = checked_operator(in.M, in.K, "M"),
                    .velocity = {.C = {}, .is_symmetric = true}};
  if (in.C) checked.velocity = checked_velocity_forces(in.C, in.K);
  phase.done();
  return checked;
}

}  // namespace

std::vector<PetscInt> held_masters(const Inside& inside)
{
  return inside.held ? indices_of_all_ranks(inside.held) : std::vector<PetscInt>{};
}

SetUp make_set_up(CMS cms)
{
  Operators checked = checked_operators(cms);
  PetscInt n = 0;
  petsc::check(MatGetSize(checked.K, &n, nullptr));
  std::vector<PetscInt> masters = indices_of_all_ranks(cms->inside->interface);
  refuse_empty_rows(checked.K, checked.M, checked_ascending(masters, n));
  reduce::ReductionOptions options = cms->inside->settings.options;
  options.solver.petsc = option_source(cms);
  CMSPhases phases(cms);
  return {.body = reduce::factored(
              {.K = std::move(checked.K), .M = std::move(checked.M), .masters = std::move(masters)},
              options, phases),
          .velocity = std::move(checked.velocity)};
}

namespace {

/// A stage of the log and the event that spans all of it, for as long as it lives.
class Stage {
 public:
  Stage(CMS cms, PetscLogStage stage, PetscLogEvent event) : cms_(cms), event_(event)
  {
    petsc::check(PetscLogStagePush(stage));
    petsc::check(PetscLogEventBegin(event_, cms_, 0, 0, 0));
  }
  ~Stage()
  {
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
