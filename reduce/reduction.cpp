#include "reduce/reduction.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/machine_memory.hpp"
#include "reduce/basis.hpp"
#include "reduce/certify.hpp"
#include "reduce/memory_forecast.hpp"
#include "reduce/support.hpp"

namespace chladni::reduce {

namespace {

petsc::IndexSet own_masters(Mat K, const std::vector<PetscInt>& masters)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::vector<PetscInt> own;
  std::ranges::copy_if(masters, std::back_inserter(own),
                       [&](PetscInt dof) { return dof >= first && dof < last; });
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(petsc::communicator(K), static_cast<PetscInt>(own.size()),
                               own.data(), PETSC_COPY_VALUES, set.put()));
  return set;
}

void let_go(petsc::Matrix& K, petsc::Matrix& M)
{
  K = {};
  M = {};
  linear::give_back_freed();  // the basis does not come from the heap
}

/// With the name of the DOF that moves most where a part of the body is free.
linear::Factorization factorized(const Body& body, Mat K_ss, const DofPartition& dofs,
                                 const linear::SolverOptions& options)
{
  try {
    return linear::factorize(K_ss, options);
  } catch (const linear::FreeMotion& free) {
    if (free.row < 0) throw;
    const PetscInt dof = dof_of_slave(dofs, free.row);
    const std::string name =
        body.name_of_dof ? body.name_of_dof(dof) : fmt::format("row {} of K", dof);
    if (name.empty()) throw;
    throw Error(fmt::format("{}; it moves most at {}", free.what(), name));
  }
}

}  // namespace

FactoredBody factored(Body body, const ReductionOptions& options, PhaseListener& phases)
{
  refuse_unkept_tolerance(options.basis);
  phases.begin("partition");
  DofPartition dofs =
      partition(body.K, own_masters(body.K, body.masters), body.may_lack_masters ? 0 : 1);
  const bool are_ordered = linear::will_solve_for_parts(options.solver.petsc);
  std::vector<int> order;
  if (are_ordered) order = order_slaves(dofs, body.K, body.M);
  Blocks K = split(body.K, dofs, options.solver.scratch);
  Blocks M = split(body.M, dofs, options.solver.scratch);
  if (are_ordered) linear::keep_order(K.ss, std::move(order));
  phases.begin("factorization");
  const MemoryForecast memory(body, K, M, options);
  linear::SolverOptions solver = options.solver;
  solver.factor = memory.at_first(solver.factor);
  if (lets_matrices_go_at_once(options)) let_go(body.K, body.M);
  linear::Factorization K_ss = factorized(body, K.ss, dofs, solver);
  phases.end();
  const auto require_memory = [memory, factor = K_ss.factor()](PetscInt n_modes) {
    memory.require(factor, n_modes);
  };
  return {.K = std::move(body.K),
          .M = std::move(body.M),
          .masters = std::move(body.masters),
          .R = std::move(body.R),
          .dofs = std::move(dofs),
          .K_blocks = std::move(K),
          .M_blocks = std::move(M),
          .K_ss = std::move(K_ss),
          .require_memory = require_memory};
}

namespace {

/// Basis and model, and what the goal of the options adds to them.
struct Made {
  Basis basis;
  ReducedModel model;
  ResponseCertificate responses = {};
};

Made made(const FactoredBody& body, const ReductionOptions& options, const Support& support,
          PhaseListener& phases)
{
  Basis basis = make_basis(body, options, support, phases);
  phases.begin("projection");
  ReducedModel model = project(basis.Q, body.K_blocks, body.M_blocks);
  Made made{.basis = std::move(basis), .model = std::move(model)};
  if (!options.responses || options.basis.method != Method::mixed_interface) return made;
  phases.begin("responses");
  std::optional<FixedInterfaceModes>& modes = made.basis.Q.modes;
  if (!modes) modes = {.Phi = linear::uninitialized_dense(body.K_blocks.ss, 0), .omega = {}};
  made.responses = keep_responses(whole_system(body), {.Q_CB = made.basis.Q, .model = made.model},
                                  rows_of_masters(body.masters, support.held()),
                                  made.basis.lambda_left_out, *options.responses);
  if (modes->omega.empty()) modes.reset();
  return made;
}

}  // namespace

Reduction reduction(FactoredBody& body, const ReductionOptions& wanted, const Support& support,
                    PhaseListener& phases)
{
  MethodChoice choice = method_choice(body, wanted, support);
  ReductionOptions options = wanted;
  options.basis.method = choice.method;
  const CountPlan count(body, options);
  if (!needs_matrices(options, count.is_possible()))  // the blocks are enough
    let_go(body.K, body.M);
  auto [basis, model, responses] = made(body, options, support, phases);
  if (basis.exact_up_to > 0.0 && !options.basis.tolerance && !options.basis.certified_up_to_Hz)
    options.basis.certified_up_to_Hz = basis.exact_up_to / (2.0 * std::numbers::pi);
  const Reduced reduced{.body = body, .Q_CB = basis.Q, .model = model};
  const bool counts = count.is_possible() && count.is_due(basis.Q.n_modes());
  phases.begin("error estimates");
  Certified certified =
      estimated(reduced, options, support, counts ? Purpose::bounds : Purpose::estimates);
  phases.begin("condition");
  certified.certificate.condition = linear::condition_estimate(body.K_ss);
  certified.certificate.count_share = count.share(basis.Q.n_modes());
  if (counts) {
    phases.begin("count of eigenvalues");
    certified.certificate = counted(std::move(certified), reduced, options, support);
  }
  certified.certificate.responses = responses;
  phases.end();
  return {.Q_CB = std::move(basis.Q),
          .model = std::move(model),
          .certificate = std::move(certified.certificate),
          .choice = std::move(choice)};
}

Reduction with_responses(Reduction reduction, const FactoredBody& body,
                         const std::vector<HarmonicLoads>& loads, PhaseListener& phases)
{
  phases.begin("responses of the whole model");
  reduction.Q_CB.modes = enrich(reduction.Q_CB, body.dofs, {body.K_blocks.ss, body.M_blocks.ss},
                                full_responses(body.K, body.M, loads, body.K_ss.options().petsc))
                             .modes;
  phases.begin("projection");
  reduction.model = project(reduction.Q_CB, body.K_blocks, body.M_blocks);
  phases.end();
  return reduction;
}

std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, const ReducedModel& model)
{
  std::vector<PetscInt> ascending = masters;
  std::ranges::sort(ascending);
  std::vector<int> places;
  places.reserve(masters.size() + model.omega.size());
  for (const PetscInt dof : masters) {
    places.push_back(
        static_cast<int>(std::ranges::lower_bound(ascending, dof) - ascending.begin()));
  }
  for (std::size_t k = 0; k < model.omega.size(); ++k)
    places.push_back(static_cast<int>(std::ssize(places)));
  return places;
}

}  // namespace chladni::reduce
