// CMSSetUp: checks, partition, factor of K_ss.
#include <algorithm>
#include <numeric>

#include "reduce/plugin/check_operators.hpp"
#include "reduce/plugin/cms_impl.hpp"
#include "reduce/plugin/guard.hpp"

namespace chladni::reduce::plugin {

namespace {

/// The interface in the order of the user, the same on every rank.
std::vector<PetscInt> all_masters(IS interface)
{
  petsc::IndexSet gathered;
  PetscInt n = 0;
  const PetscInt* indices = nullptr;
  petsc::check(ISAllGather(interface, gathered.put()));
  petsc::check(ISGetSize(gathered, &n));
  petsc::check(ISGetIndices(gathered, &indices));
  std::vector<PetscInt> masters(indices, indices + n);
  petsc::check(ISRestoreIndices(gathered, &indices));
  return masters;
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
  if (twin != masters.end()) {
    throw Error(fmt::format("CMSSetInterface: master {} is given twice", *twin));
  }
  return masters;
}

petsc::IndexSet own_part(Mat K, const std::vector<PetscInt>& ascending)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  const auto begin = std::ranges::lower_bound(ascending, first);
  const auto end = std::ranges::lower_bound(ascending, last);
  petsc::IndexSet own;
  petsc::check(ISCreateGeneral(petsc::communicator(K), static_cast<PetscInt>(end - begin),
                               ascending.data() + (begin - ascending.begin()), PETSC_COPY_VALUES,
                               own.put()));
  return own;
}

std::vector<int> places_of(const std::vector<PetscInt>& masters,
                           const std::vector<PetscInt>& ascending)
{
  std::vector<int> places;
  places.reserve(masters.size());
  for (const PetscInt dof : masters) {
    places.push_back(
        static_cast<int>(std::ranges::lower_bound(ascending, dof) - ascending.begin()));
  }
  return places;
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

Factorization factorized(CMS cms, Mat K_ss, const DofPartition& rows)
{
  Phase phase(cms, events.factor, "factorization");
  try {
    SolverOptions options = cms->inside->settings.solver;
    options.petsc = option_source(cms);
    Factorization factor = factorize(K_ss, options);
    phase.done();
    return factor;
  } catch (const FreeMotion& free) {
    if (free.row < 0) throw;
    throw Error(
        fmt::format("{}; it moves most at row {} of K", free.what(), dof_of_slave(rows, free.row)));
  }
}

}  // namespace

SetUp make_set_up(CMS cms)
{
  Operators checked = checked_operators(cms);
  PetscInt n = 0;
  petsc::check(MatGetSize(checked.K, &n, nullptr));
  std::vector<PetscInt> masters = all_masters(cms->inside->interface);
  const std::vector<PetscInt> ascending = checked_ascending(masters, n);
  refuse_empty_rows(checked.K, checked.M, ascending);
  std::vector<int> places = places_of(masters, ascending);
  DofPartition rows = partition(checked.K, own_part(checked.K, ascending));
  Blocks K = split(checked.K, rows);
  Blocks M = split(checked.M, rows);
  Factorization K_ss = factorized(cms, K.ss, rows);
  return {.K = std::move(checked.K),
          .M = std::move(checked.M),
          .velocity = std::move(checked.velocity),
          .masters = std::move(masters),
          .places = std::move(places),
          .rows = std::move(rows),
          .K_blocks = std::move(K),
          .M_blocks = std::move(M),
          .K_ss = std::move(K_ss)};
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
}  // namespace chladni::reduce::plugin

using namespace chladni::reduce::plugin;  // NOLINT(google-build-using-namespace)

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
