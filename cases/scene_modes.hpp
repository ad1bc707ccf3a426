#pragma once

#include <Eigen/Core>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "reduce/supported_solutions.hpp"

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
