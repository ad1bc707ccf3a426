#pragma once

#include <memory>
#include <optional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/snapshot_recorder.hpp"
#include "squeal/transient/transient_plan.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {

/// A transient that is ready to begin.
struct PreparedTransient {
  RecordingPlan plan;
  std::string integrator;  ///< as in the scene
  std::string reason;      ///< why, for people
  double rest_height;      ///< z of the first upper pad at rest, m
  double first_sample;     ///< its time over the distance of the samples
  std::unique_ptr<TransientSteps> steps;
  std::optional<SnapshotRecorder> states;  ///< of a brake with a body; reads `modal`
  const ModalSteps* modal;                 ///< the steps of a brake with a body; else null
};

/// @param brake, run  outlive the result
/// @throws chladni::Error as `transient`.
PreparedTransient prepared_transient(const Brake& brake, const TransientCase& run);

/// The lowest angular frequency of the small motions of the brake at a speed, rad/s.
double lowest_frequency(const Brake& brake, double speed);

}  // namespace chladni::squeal
