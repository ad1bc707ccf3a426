#pragma once

#include <Eigen/Core>

#include <vector>

#include "cases/fe_model.hpp"
#include "linear/solver_options.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/free_motions.hpp"
#include "reduce/supported_solutions.hpp"
#include "report/fe/vtu.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"

/// The steps that `chladni static` and `chladni modes` share.

namespace chladni::cases {

/// The FE model under the supports of the scene.
struct SupportedModel {
  mesh::Mesh mesh;
  plate::System system;
  std::vector<int> owners;            ///< [n_nodes of the mesh] rank of each node
  std::vector<int> held;              ///< DOFs, ascending
  std::vector<plate::FreePart> free;  ///< parts that can still move as rigid bodies
};

/// Assembles the FE model of a scene on a given mesh.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel assemble_supported(const scene::Scene& scene, mesh::Mesh mesh);

/// Assembles the FE model of a scene on its mesh, or, if it asks for an accuracy, on a mesh that
/// keeps it. The phase of the assembly is still open when it returns.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SupportedModel supported_model(const scene::Scene& scene, const linear::SolverOptions& solver,
                               Phases& phases);

/// A table of the sizes of the model.
report::TextTable model_table(const SupportedModel& model);

/// The JSON members `n_nodes`, `n_dofs`, `n_held`, `n_rigid`.
std::vector<report::Json::Member> model_json(const SupportedModel& model);

}  // namespace chladni::cases

/// The computation and output of `chladni static`.

namespace chladni::cases {

/// The static solution of a model under its loads, on every rank.
struct StaticFields {
  Eigen::MatrixXd motions;    ///< [n_nodes x 6] m, rad
  Eigen::MatrixXd reactions;  ///< [n_active x 6] N, N m, on the body
  double work;                ///< J, by the loads: twice the strain energy
  /// at the nodes, for each section
  std::vector<plate::ShellResultants> resultants;
  /// Pa, at the nodes, for each section of solids
  std::vector<Eigen::MatrixXd> stresses;
};

/// Displacements and section forces under the loads of the scene.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike when a part of the body can move freely.
StaticFields static_fields(const scene::Scene& scene, const SupportedModel& model,
                           const linear::SolverOptions& solver);

/// A table of the largest displacement, the sum of the reactions, the strain energy, and of solids
/// the largest stress.
report::TextTable static_table(const StaticFields& found);

/// A table of the displacements of the nodes in the groups that the scene wants reported.
report::TextTable reported_table(const scene::Scene& scene, const SupportedModel& model,
                                 const StaticFields& found);

/// The JSON members `largest_displacement_m`, `reaction_N`, `strain_energy_J`, of solids
/// `largest_von_mises_Pa`, and `motions` of each node of the reported groups, with the stresses of
/// solids, after those of `model_json`.
std::vector<report::Json::Member> static_json(const scene::Scene& scene,
                                              const SupportedModel& model,
                                              const StaticFields& found);

/// Displacements and section forces for ParaView, on the first rank.
report::VtuGrid static_picture(const scene::Scene& scene, const SupportedModel& model,
                               const StaticFields& found);

}  // namespace chladni::cases

/// The computation and output of `chladni modes`.

namespace chladni::cases {

/// Natural modes of a scene under its supports.
struct SceneModes {
  reduce::NaturalModes modes;
  int n_rigid;            ///< number of rigid-body motions, which come first
  Eigen::VectorXd omega;  ///< rad/s; exactly 0 for rigid-body motions
  /// [elastic modes] relative, or empty; see mesh_errors.hpp
  Eigen::VectorXd mesh_errors;
};

/// The number of modes that the scene asks for, with the errors of the mesh if it asks for these.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SceneModes scene_modes(const scene::Scene& scene, const SupportedModel& model,
                       const linear::SolverOptions& solver, Phases& phases);

/// A table of frequency, kind and error of each mode.
report::TextTable mode_table(const SceneModes& found);

/// The JSON members `n_modes`, `frequencies_Hz` and `errors_of_mesh`, after those of `model_json`.
std::vector<report::Json::Member> modes_json(const SupportedModel& model, const SceneModes& found);

/// The picture of all modes, on the first rank. Each mode is scaled to a largest displacement of 1.
/// @note   Collective on all ranks.
report::SceneGrid mode_grid(const scene::Scene& scene, const SupportedModel& model,
                            const reduce::NaturalModes& modes);

}  // namespace chladni::cases
