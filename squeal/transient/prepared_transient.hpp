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

/// A transient that is ready to start.
struct PreparedTransient {
  RecordingPlan plan;
  std::string integrator;  ///< name as in the scene
  std::string reason;      ///< reason of the choice, for the user
  double rest_height;      ///< height z of the first upper pad at rest, m
  double first_sample;     ///< time of the first sample divided by the sampling step
  std::unique_ptr<TransientSteps> steps;
  std::optional<SnapshotRecorder> states;  ///< for a brake with a body; reads `modal`
  const ModalSteps* modal;                 ///< the steps of a brake with a body, else null
};

/// Prepares a transient.
/// @param brake, run  must outlive the result
/// @throws chladni::Error as `transient`.
PreparedTransient prepared_transient(const Brake& brake, const TransientCase& run);

/// Lowest angular frequency of small motions of the brake at a speed (rad/s), rad/s.
double lowest_frequency(const Brake& brake, double speed);

}  // namespace chladni::squeal
