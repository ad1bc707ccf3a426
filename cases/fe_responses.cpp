#include "cases/fe_responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "cases/chosen_mesh.hpp"
#include "cases/fe_model.hpp"
#include "linear/progress.hpp"
#include "mbs_export/responses/frequency_responses.hpp"
#include "mbs_export/responses/response_options.hpp"
#include "plate/dofs/drilling.hpp"
#include "reduce/harmonic_response.hpp"

namespace chladni::cases {
namespace {

using mbs_export::Damping;
using mbs_export::FrequencyResponses;
using mbs_export::ResponseDof;
using mbs_export::ResponseOptionError;

/// The nodes of all places of the scene, as the files number them.
struct PlacedNodes {
  std::vector<mbs_export::AttachmentNode> nodes;
  std::vector<mbs_export::AttachmentSet> sets;
  std::vector<int> places;  ///< of the nodes, in the DofMap

  mbs_export::NamedNodes named() const { return {nodes, sets}; }
};

PlacedNodes placed_nodes(const mbs_export::ResponseOptions& options, const SupportedModel& model)
{
  const plate::DofMap& dofs = model.system.dofs;
  const Eigen::MatrixX3d axes = plate::drilling_axes(model.mesh, dofs);
  std::set<std::string> names;
  for (const auto* const places : {&options.loads, &options.outputs})
    for (const mbs_export::ResponsePlace& place : *places) names.insert(place.at);
  PlacedNodes placed;
  for (const std::string& name : names) {
    mbs_export::AttachmentSet set{.name = name, .nodes = {}};
    for (const int node : dofs.named_nodes(model.mesh, name)) {
      set.nodes.push_back(static_cast<int>(placed.nodes.size()));
      placed.places.push_back(node);
      placed.nodes.push_back({.number = node_number(model.mesh, dofs, node),
                              .position = dofs.position(node),
                              .drilling_axis = axes.row(node)});
    }
    placed.sets.push_back(std::move(set));
  }
  return placed;
}

/// The share of each DOF in a motion; couplings give a node several.
reduce::DofForm form_of(const ResponseDof& asked, const PlacedNodes& placed,
                        const SupportedModel& model)
{
  const plate::DofMap& dofs = model.system.dofs;
  std::map<int, double> weights;
  for (const int at : asked.nodes) {
    for (const plate::MotionTerm& term : dofs.motion(placed.places[static_cast<std::size_t>(at)]))
      for (const int c : dofs.components())
        if (const double share = term.T(asked.component, c); share != 0.0) {
          weights[*dofs.dof_of_number(term.number, c)] +=
              share / static_cast<double>(asked.nodes.size());
        }
  }
  reduce::DofForm form;
  for (const auto& [dof, weight] : weights) {
    if (std::ranges::binary_search(model.held, dof)) continue;
    form.dofs.push_back(dof);
    form.weights.push_back(weight);
  }
  if (form.dofs.empty()) {
    throw ResponseOptionError(
        asked.key,
        fmt::format("{} does not move: it is held, or no part of the model", asked.name));
  }
  return form;
}

std::vector<reduce::DofForm> forms_of(const std::vector<ResponseDof>& asked,
                                      const PlacedNodes& placed, const SupportedModel& model)
{
  std::vector<reduce::DofForm> forms;
  for (const ResponseDof& one : asked) forms.push_back(form_of(one, placed, model));
  return forms;
}

/// K, M and what damps them.
reduce::HarmonicModel damped_model(const scene::Scene& scene, const SupportedModel& model)
{
  const Damping& damping = scene.body.damping;
  reduce::HarmonicModel damped{
      .K = model.system.K, .M = model.system.M, .loss_factor = scene.response->loss_factor};
  if (damping.type == Damping::Type::modal) {
    scene::refuse_key(scene, "body.damping.type",
                      "the FE model knows no modes to damp; take \"rayleigh\", or "
                      "response.loss_factor without it");
  }
  if (damping.type == Damping::Type::matrix) {
    damped.C = model.system.C;
    damped.H = model.system.H;
    if (damped.C == nullptr && damped.H == nullptr) {
      scene::refuse_key(scene, "body.damping.type",
                        "'matrix' needs dampers or loss factors, and the model has none");
    }
  }
  if (damping.type == Damping::Type::rayleigh) {
    damped.alpha = damping.alpha;
    damped.beta = damping.beta;
  }
  return damped;
}

/// A part that can move freely has no static response.
void refuse_free_motion(const scene::Scene& scene, const SupportedModel& model)
{
  if (scene.response->range.from_Hz > 0.0 || model.free.empty()) return;
  scene::refuse_key(scene, "response.from_Hz",
                    fmt::format("at 0 Hz the model moves freely in {}, and its response has no "
                                "bound; begin above, or hold it",
                                describe_motions(model.free.front())));
}

/// Without values.
FrequencyResponses unanswered(const scene::Scene& scene, const PlacedNodes& placed,
                              const std::vector<ResponseDof>& loads,
                              const std::vector<ResponseDof>& outputs)
{
  const mbs_export::ResponseOptions& options = *scene.response;
  FrequencyResponses asked{.title = scene.title,
                           .model = options.model,
                           .quantity = options.quantity,
                           .Omega = mbs_export::angular_frequencies(options),
                           .loss_factor = options.loss_factor,
                           .damping = mbs_export::name_of(scene.body.damping.type),
                           .loads = {},
                           .outputs = {},
                           .H = {}};
  for (const ResponseDof& load : loads) {
    asked.loads.push_back(point_of(placed.named(), load));
    asked.H.emplace_back(asked.Omega.size(), std::ssize(outputs));
  }
  for (const ResponseDof& output : outputs)
    asked.outputs.push_back(point_of(placed.named(), output));
  if (options.measurement)
    asked.measured = mbs_export::measured_beside(*options.measurement, asked);
  return asked;
}

FrequencyResponses answered(const scene::Scene& scene, const SupportedModel& model,
                            const linear::SolverOptions& solver)
{
  const PlacedNodes placed = placed_nodes(*scene.response, model);
  const std::vector<ResponseDof> loads = response_loads(placed.named(), scene.response->loads),
                                 outputs =
                                     response_outputs(placed.named(), scene.response->outputs);
  FrequencyResponses found = unanswered(scene, placed, loads, outputs);
  reduce::HarmonicResponse response(
      damped_model(scene, model), reduce::free_dofs(model.system.K, model.held),
      forms_of(loads, placed, model), forms_of(outputs, placed, model), solver.petsc);
  for (Eigen::Index f = 0; f < found.Omega.size(); ++f) {
    const Eigen::MatrixXcd H = response.at(found.Omega[f]);
    const std::complex<double> rate = rate_factor(found.quantity, found.Omega[f]);
    for (Eigen::Index l = 0; l < H.cols(); ++l)
      found.H[static_cast<std::size_t>(l)].row(f) = rate * H.col(l).transpose();
    linear::report_progress(double(f + 1) / double(found.Omega.size()));
  }
  return found;
}

}  // namespace

scene::Scene held_as_body(const scene::Scene& scene)
{
  scene::Scene held = scene;
  if (scene.interface_nodes.empty()) return held;
  held.supports = supports_of(scene);
  return held;
}

FrequencyResponses fe_responses(const scene::Scene& scene, const SupportedModel& model,
                                const linear::SolverOptions& solver, Phases& phases)
{
  phases.begin("frequencies");
  expect_mass(scene);
  refuse_free_motion(scene, model);
  try {
    FrequencyResponses found = answered(scene, model, solver);
    phases.end();
    return found;
  } catch (const ResponseOptionError& error) {
    scene::refuse_key(scene, "response." + error.key(), error.why());
  } catch (const reduce::Resonance& error) {
    scene::refuse_key(scene, "response.from_Hz",
                      fmt::format("in the range {}, where the response has no bound; give damping "
                                  "(body.damping, response.loss_factor) or other frequencies",
                                  error.what()));
  }
}

}  // namespace chladni::cases
