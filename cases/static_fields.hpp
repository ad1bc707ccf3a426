#pragma once

#include <Eigen/Core>
#include <vector>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "plate/assembly/recovery.hpp"
#include "report/fe/vtu.hpp"

/// The computation and output of `chladni static`.
namespace chladni::cases {

/// The static solution of a model under its loads, on every rank.
struct StaticFields {
  Eigen::MatrixXd motions;    ///< [n_nodes x 6] m, rad
  Eigen::MatrixXd reactions;  ///< [n_active x 6] N, N m, on the body
  double work;                ///< J, by the loads: twice the strain energy
  /// at the nodes, for each section
  std::vector<plate::ShellResultants> resultants;
};

/// Displacements and section forces under the loads of the scene.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike when a part of the body can move freely.
StaticFields static_fields(const scene::Scene& scene, const SupportedModel& model,
                           const linear::SolverOptions& solver);

/// A table of the largest displacement, the sum of the reactions and the strain energy.
report::TextTable static_table(const StaticFields& found);

/// A table of the displacements of the nodes in the groups that the scene wants reported.
report::TextTable reported_table(const scene::Scene& scene, const SupportedModel& model,
                                 const StaticFields& found);

/// The JSON members `largest_displacement_m`, `reaction_N`, `strain_energy_J`, and `motions` of
/// each node of the reported groups, after those of `model_json`.
std::vector<report::Json::Member> static_json(const scene::Scene& scene,
                                              const SupportedModel& model,
                                              const StaticFields& found);

/// Displacements and section forces for ParaView, on the first rank.
report::VtuGrid static_picture(const scene::Scene& scene, const SupportedModel& model,
                               const StaticFields& found);

}  // namespace chladni::cases
