#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cases/phases.hpp"
#include "linear/cholesky/cholesky_types.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "reduce/reduction.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A reduced system and what it took to make it.
struct ReduceSummary {
  mbs_export::ReducedSystem reduced;      ///< on the first rank; empty on the others
  std::vector<report::PhaseTime> phases;  ///< of this rank, in order
  std::int64_t n_dofs;                    ///< of the FE model, after elimination of the couplings
  std::int64_t n_nodes;                   ///< of the mesh
  int n_masters;
  reduce::MethodChoice choice;
  int n_modes;        ///< of the method
  int n_modes_asked;  ///< of these, by their number; 0 where something else has chosen them
  report::PhaseTime factorization;  ///< of K_ss, on this rank; part of one of the phases
  linear::FactorSize factor;
  double modes_residual;  ///< largest of the fixed-interface modes; 0 of other methods
};

/// What was said of the solvers after `--`.
struct SaidOfSolvers {
  std::string text;  ///< all of it, for the provenance; PETSc knows it already
  linear::SolverOptions options = {};
};

/// Where a result of the scene's FE model comes from.
mbs_export::Provenance provenance(const scene::Scene& scene, const SaidOfSolvers& solvers,
                                  const mesh::Mesh& mesh);

/// Meshes, assembles and reduces the scene.
/// @note   Collective on all ranks; PETSc and SLEPc are initialised.
/// @throws chladni::Error on all ranks alike.
ReduceSummary reduce_scene(const scene::Scene& scene, const SaidOfSolvers& solvers,
                           const ReduceProgress& progress);

}  // namespace chladni::cases
