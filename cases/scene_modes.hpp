#pragma once

#include <Eigen/Core>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "reduce/supported_solutions.hpp"

/// What `chladni modes` finds and tells.
namespace chladni::cases {

/// Natural modes of a scene under its supports.
struct SceneModes {
  reduce::NaturalModes modes;
  int n_rigid;                  ///< of these, the first ones
  Eigen::VectorXd omega;        ///< rad/s; rigid-body motions have 0, whatever round-off says
  Eigen::VectorXd mesh_errors;  ///< [elastic modes] relative, or none; see mesh_errors.hpp
};

/// As many as the scene asks for, with the errors of the mesh if it asks for these.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
SceneModes scene_modes(const scene::Scene& scene, const SupportedModel& model,
                       const linear::SolverOptions& solver, Phases& phases);

/// Frequency, kind and error of each mode.
report::TextTable mode_table(const SceneModes& found);

/// Members `n_modes`, `frequencies_Hz` and `errors_of_mesh`, behind those of model_json().
std::vector<report::Json::Member> modes_json(const SupportedModel& model, const SceneModes& found);

/// The picture of all modes, on the first rank; each is scaled to a largest displacement of 1.
/// @note Collective on all ranks.
report::SceneGrid mode_grid(const scene::Scene& scene, const SupportedModel& model,
                            const reduce::NaturalModes& modes);

}  // namespace chladni::cases
