#include "cases/scene_responses.hpp"

#include "mbs_export/body_option_error.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/responses/response_option_error.hpp"

namespace chladni::cases {

using mbs_export::FrequencyResponses;

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
