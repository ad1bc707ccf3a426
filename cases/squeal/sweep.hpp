#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cases/squeal/sweep_values.hpp"
#include "scene/scene.hpp"
#include "scene/scene_numbers.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::cases {

/// A scene and the places of its text in which variants have other numbers.
struct SweepCase {
  scene::Scene scene;
  std::vector<std::string> analyses;                    ///< replace those of the scene
  std::vector<std::vector<scene::NumberPlace>> places;  ///< [n_keys]
  /// Brake of the unchanged scene. Variants share its disc unless they need another one.
  std::shared_ptr<const squeal::Brake> brake;
  /// Makes the brake of a variant that needs another disc.
  std::function<std::shared_ptr<const squeal::Brake>(const scene::Scene&)> make_brake;
};

/// A brake of the sweep and its study.
struct Variant {
  squeal::StudyOptions study;
  std::shared_ptr<const squeal::Brake> brake;
};

/// The variant with these values of the keys.
Variant variant_of(const SweepCase& sweep, const Eigen::VectorXd& values);

/// Reads every variant and checks its study against its brake, before any is computed.
/// @throws chladni::Error with the number of the first invalid variant, its values, and what is
///         wrong: file, line, key and what is allowed, or the range that the body has.
void check_variants(const SweepCase& sweep, const squeal::SweepTable& table);

/// Callbacks and threads of a long sweep.
struct SweepKeeping {
  /// Called after each variant, by one thread at a time.
  std::function<void(const squeal::SweepTable&)> done_another = {};
  unsigned n_threads = 0;  ///< 0: the number of processors
};

/// Computes the variants that are still to do, several at a time. Each is computed by one thread
/// from its scene alone, so the table depends neither on the number of threads nor on what was done
/// before.
squeal::SweepTable sweep(const SweepCase& sweep, squeal::SweepTable table,
                         const SweepKeeping& keeping);

}  // namespace chladni::cases
