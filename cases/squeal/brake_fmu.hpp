#pragma once

#include <filesystem>

#include "mbs_export/formats/fmu_archive.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The options of an FMU of a brake.
struct BrakeFmuOptions {
  mbs_export::formats::FmiVersion version;
  std::string identifier;
  std::filesystem::path folder;  ///< that contains NAME.body.h5
  report::Stale stale;
};

/// The brake of a scene's [squeal] as Functional Mock-up Unit. Inputs are speed, friction and
/// preloads, outputs are forces and motions of the pads, states are the angle and the modes.
/// Contact is as in the scene.
/// @throws chladni::Error when the scene has no disc with a body, its body is missing or of another
///         scene, and as `mbs_export::formats::fmu_archive`.
mbs_export::formats::Fmu fmu_of_brake(const scene::Scene& scene, const BrakeFmuOptions& options);

}  // namespace chladni::cases
