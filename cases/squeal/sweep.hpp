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

/// The variants of a scene: its text with other numbers in some places.
struct SweepCase {
  scene::Scene scene;
  std::vector<std::string> analyses;                    ///< in the place of the scene's
  std::vector<std::vector<scene::NumberPlace>> places;  ///< [n_keys]
  /// Of the scene as it is; variants share its disc where they need no other one.
  std::shared_ptr<const squeal::Brake> brake;
  /// Makes the brake of a variant that needs another disc.
  std::function<std::shared_ptr<const squeal::Brake>(const scene::Scene&)> make_brake;
};

/// One brake of the sweep, and what is asked of it.
struct Variant {
  squeal::StudyOptions study;
  std::shared_ptr<const squeal::Brake> brake;
};

Variant variant_of(const SweepCase& sweep, const Eigen::VectorXd& values);

/// Reads every variant and checks what it asks of its brake, before any is computed.
/// @throws chladni::Error with the number of the first variant that cannot be, its values, and what
///         is wrong: file, line, key and what is allowed, or the range that the body has.
void check_variants(const SweepCase& sweep, const squeal::SweepTable& table);

/// What goes along with a long sweep; called by one thread at a time.
struct SweepKeeping {
  std::function<void(const squeal::SweepTable&)> done_another = {};
  unsigned n_threads = 0;  ///< 0: as many as there are processors
};

/// Computes the variants that are to do, several at a time. Each one is computed by one thread from
/// its scene alone, so that the table depends neither on their number nor on what had been done.
squeal::SweepTable sweep(const SweepCase& sweep, squeal::SweepTable table,
                         const SweepKeeping& keeping);

}  // namespace chladni::cases
