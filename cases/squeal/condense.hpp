#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "scene/scene.hpp"
#include "squeal/condensation/condensation.hpp"

namespace chladni::cases {

/// What to condense the bodies of an assembly for.
struct CondenseRequest {
  double tolerance;  ///< largest relative error of an eigenvalue of the band
  double up_to_Hz;   ///< end of the band
};

/// A part before and after.
struct CondensedPart {
  std::string name;
  std::filesystem::path file;  ///< of the condensed body, to be written
  Eigen::Index before, after;  ///< coordinates
};

struct CondensedBrake {
  std::vector<CondensedPart> parts;
  squeal::CondensedBodies found;
};

/// Condenses the bodies of a scene's assembly over its speeds, as `squeal::condense`.
/// @return bodies whose provenance is that of the files they are made of
/// @throws chladni::Error when the scene has another model, and from reading and condensing.
CondensedBrake condensed_brake(const scene::Scene& scene, const SquealFiles& files,
                               StaleChoice stale, const CondenseRequest& request);

/// The files that `write` makes: NAME.condensed/PART.body.h5 in the folder of the results.
std::vector<std::filesystem::path> condensed_files(const scene::Scene& scene,
                                                   const SquealFiles& files);

/// @throws chladni::Error when a file cannot be written.
void write(const CondensedBrake& brake);

}  // namespace chladni::cases
