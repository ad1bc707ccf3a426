#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cases/phases.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "reduce/reduce_options.hpp"
#include "reduce/reduction.hpp"
#include "report/json.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A reduced system and the cost of its reduction.
struct ReduceSummary {
  mbs_export::ReducedSystem reduced;      ///< on the first rank; empty on the others
  std::vector<report::PhaseTime> phases;  ///< of this rank, in order
  std::int64_t n_dofs;                    ///< of the FE model, after elimination of the couplings
  std::int64_t n_nodes;                   ///< of the mesh
  int n_masters;
  reduce::MethodChoice choice;
  int n_modes;        ///< of the method
  int n_modes_asked;  ///< number of modes asked for; 0 if no number was given
  /// of K_ss, on this rank; part of one of the phases
  report::PhaseTime factorization;
  linear::FactorSize factor;
  /// largest residual of the fixed-interface modes; 0 for other methods
  double modes_residual;
};

/// The solver options that follow `--`.
struct SaidOfSolvers {
  std::string text;  ///< all of it, for the provenance; PETSc knows it already
  linear::SolverOptions options = {};
};

/// The provenance of a result of the scene's FE model.
mbs_export::Provenance provenance(const scene::Scene& scene, const SaidOfSolvers& solvers,
                                  const mesh::Mesh& mesh);

/// Meshes, assembles and reduces the scene.
/// @note   Collective on all ranks; PETSc and SLEPc must be initialised.
/// @throws chladni::Error on all ranks alike.
ReduceSummary reduce_scene(const scene::Scene& scene, const SaidOfSolvers& solvers,
                           const ReduceProgress& progress);

struct MeshedScene;

/// Reduces a scene with one sector meshed, harmonic by harmonic; the ranks share the harmonics. The
/// reduced system is that of the whole body: its masters are the DOFs of nodes on the axis and the
/// harmonics of rings, its modes come in exact pairs.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, also for what is not implemented for sectors.
ReduceSummary reduce_sectors(const scene::Scene& scene, MeshedScene meshed,
                             const linear::SolverOptions& solver, Phases& phases);

/// The phases of a reduction in their order, with their usual share of the time, per cent.
std::vector<report::Stage> stages_of(const reduce::ReduceOptions& wanted);

/// The phases of a reduction from one sector, with their usual share of the time, per cent.
std::vector<report::Stage> stages_of_sectors();

/// A table of the sizes of a reduction and the cost of its factorisation.
report::TextTable reduction_table(const ReduceSummary& summary);

/// The table of `reduction_table`, and a line with the reason if the method was chosen
/// automatically.
std::string described_reduction(const ReduceSummary& summary);

/// The JSON members `n_dofs`, `n_nodes`, `n_masters`, `n_modes`, `certified_frequencies_Hz` with
/// their `eta2`, `factor_wall_s`, `factor_cpu_s`.
std::vector<report::Json::Member> reduction_json(const ReduceSummary& summary);

}  // namespace chladni::cases
