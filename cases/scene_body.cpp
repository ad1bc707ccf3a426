#include "cases/scene_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>
#include <utility>

#include "mbs_export/body_options.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::cases {

using mbs_export::FrequencyResponses;

namespace {

/// What [body] asks for in vain is told with its place in the scene.
mbs_export::ModalBody made_body(const scene::Scene& scene, const mbs_export::ReducedSystem& reduced)
{
  try {
    return mbs_export::make_body(reduced, scene.body);
  } catch (const mbs_export::BodyOptionError& error) {
    scene::refuse_key(scene, "body." + error.key(), error.why());
  }
}

/// Stiffening belongs to the support that the stress was computed with.
void add_note_of_stiffening(const mbs_export::ModalBody& body,
                            const mbs_export::ReducedSystem& reduced,
                            std::vector<std::string>& notes)
{
  if (!reduced.stiffening || body.stiffening) return;
  notes.push_back(fmt::format(
      "the body has no geometric stiffening: the reduced system has that of fixed = [{}]; reduce "
      "the scene again to have it for this support",
      fmt::join(reduced.stiffening->fixed, ", ")));
}

/// Modes beyond the last one that the reduction has an error estimate for are kept where a
/// frequency asks for them, but told.
std::vector<std::string> notes_of(const scene::Scene& scene, const mbs_export::ModalBody& body,
                                  const mbs_export::Certificate& certificate)
{
  if (scene.body.keep.tolerance && !body.selection) {
    return {
        fmt::format("body.fixed holds all that could be loaded: the body has all {} modes of the "
                    "range, and what it promises are their frequencies",
                    body.n_modes())};
  }
  const Eigen::VectorXd& certified = certificate.frequencies;
  if (!scene.body.keep.up_to_Hz || certified.size() == 0) return {};
  constexpr double same_mode = 1.0 + 1e-3;
  const double last = certified[certified.size() - 1];
  const auto n_beyond = (body.omega.array() > last * same_mode).count();
  if (n_beyond == 0) return {};
  return {
      fmt::format("body.keep keeps {} modes above {:.6g} Hz, where the error estimates of the "
                  "reduction end; they may be far off",
                  n_beyond, last / (2.0 * std::numbers::pi))};
}

}  // namespace

SceneBody scene_body(const scene::Scene& scene, const mbs_export::ReducedSystem& reduced)
{
  mbs_export::ModalBody body = made_body(scene, reduced);
  std::vector<std::string> notes = notes_of(scene, body, reduced.certificate);
  add_note_of_stiffening(body, reduced, notes);
  if (scene.squeal && body.n_free_rigid > 0) {
    scene::refuse_key(
        scene, "body.fixed",
        fmt::format("leaves the body free to move as a rigid one in {} ways, but [squeal] "
                    "needs a body that is held; hold an interface node ({}) with all its "
                    "DOFs, or take [squeal] out",
                    body.n_free_rigid, fmt::join(scene.interface_nodes, ", ")));
  }
  // That of the body may be younger.
  body.provenance.reduction_scene = std::exchange(body.provenance.scene, scene.text);
  return {.body = std::move(body), .notes = std::move(notes)};
}

FrequencyResponses body_responses(const scene::Scene& scene, const mbs_export::ModalBody& body)
{
  try {
    FrequencyResponses found = mbs_export::frequency_responses(body, *scene.response);
    found.provenance.body_scene = found.provenance.scene;
    found.provenance.scene = scene.text;
    return found;
  } catch (const mbs_export::ResponseOptionError& error) {
    scene::refuse_key(scene, "response." + error.key(), error.why());
  }
}

FrequencyResponses reduced_responses(const scene::Scene& scene,
                                     const mbs_export::ReducedSystem& reduced)
{
  mbs_export::BodyOptions all_modes{
      .fixed = scene.body.fixed, .keep = {}, .interface_modes = {}, .damping = scene.body.damping};
  try {
    mbs_export::ModalBody body = mbs_export::make_body(reduced, all_modes);
    body.provenance.reduction_scene = body.provenance.scene;
    FrequencyResponses found = body_responses(scene, body);
    found.damping = mbs_export::name_of(scene.body.damping.type);
    found.provenance.body_scene.clear();
    return found;
  } catch (const mbs_export::BodyOptionError& error) {
    scene::refuse_key(scene, "body." + error.key(), error.why());
  }
}

}  // namespace chladni::cases
