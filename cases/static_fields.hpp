#pragma once

#include <Eigen/Core>
#include <vector>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "plate/assembly/recovery.hpp"
#include "report/fe/vtu.hpp"

/// What `chladni static` finds and tells.
namespace chladni::cases {

/// Of a model under its loads, on every rank.
struct StaticFields {
  Eigen::MatrixXd motions;                         ///< [n_nodes x 6] m, rad
  Eigen::MatrixXd reactions;                       ///< [n_active x 6] N, N m on the body
  double work;                                     ///< J, of the loads: twice the strain energy
  std::vector<plate::ShellResultants> resultants;  ///< at the nodes, of each section
};

/// Displacements and section forces under the loads of the scene.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike when a part of the body can move freely.
StaticFields static_fields(const scene::Scene& scene, const SupportedModel& model,
                           const linear::SolverOptions& solver);

/// Largest displacement, sum of the reactions, strain energy.
report::TextTable static_table(const StaticFields& found);

/// Displacements of the nodes of the groups that the scene wants reported.
report::TextTable reported_table(const scene::Scene& scene, const SupportedModel& model,
                                 const StaticFields& found);

/// Members `largest_displacement_m`, `reaction_N`, `strain_energy_J`, and `motions` of each node of
/// the reported groups, behind those of model_json().
std::vector<report::Json::Member> static_json(const scene::Scene& scene,
                                              const SupportedModel& model,
                                              const StaticFields& found);

/// Displacements and section forces for ParaView. On the first rank.
report::VtuGrid static_picture(const scene::Scene& scene, const SupportedModel& model,
                               const StaticFields& found);

}  // namespace chladni::cases
