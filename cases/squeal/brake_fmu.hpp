#pragma once

#include <filesystem>

#include "mbs_export/formats/fmu.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// What is to be told to make an FMU of a brake.
struct BrakeFmuOptions {
  mbs_export::formats::FmiVersion version;
  std::string identifier;
  std::filesystem::path folder;  ///< of NAME.body.h5
  report::Stale stale;
};

/// The brake of a scene's [squeal] as Functional Mock-up Unit: speed, friction and preloads in,
/// forces and motions of the pads out, angle and modes as states. Contact follows the scene.
/// @throws chladni::Error when the scene has no disc with a body, its body is missing or of another
///         scene, and as mbs_export::formats::fmu_archive.
mbs_export::formats::Fmu fmu_of_brake(const scene::Scene& scene, const BrakeFmuOptions& options);

}  // namespace chladni::cases
