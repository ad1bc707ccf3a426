#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "common/files/hdf5.hpp"
#include "scene/scene.hpp"
#include "scene/scene_text.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::cases {

/// The keys of a scene that vary, and their values in each variant.
struct SweepValues {
  std::vector<std::string> keys;
  files::RowMajorMatrix values;  ///< [n_variants x n_keys], in the units of the scene
};

/// The largest number of variants; more are taken for a mistake in a count.
inline constexpr double variants_max = 1e6;

/// The grid of some keys; the last one varies fastest.
/// @param words  "KEY=FROM:TO:COUNT", equally spaced with both ends, or "KEY=VALUE,VALUE,..."
/// @throws chladni::Error for a word of another form, a key that occurs twice, and for more than
///         `variants_max` variants.
SweepValues sweep_grid(const std::vector<std::string>& words);

/// The variants in a file of comma-separated values: keys in the first line, then numbers.
/// @throws chladni::Error naming file, line and cell.
SweepValues read_samples(const std::string& file);

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

/// The request for a sweep.
struct SweepRequest {
  std::string scene;                   ///< path of the scene file
  std::filesystem::path folder, body;  ///< as for `squeal_files`
  SweepValues values;
  /// Empty: those of the scene that yield single numbers.
  std::vector<std::string> analyses;
  StaleChoice stale;
};

/// A sweep with its scene and table.
struct SweepStudy {
  SweepCase sweep;
  squeal::SweepTable table;  ///< with all variants to do
  squeal::RunOrigin origin;
  std::vector<std::string> notes;
};

/// Prepares a sweep.
/// @param scene_file  path of the scene file relative to the folder of the results
/// @throws chladni::Error when the scene, a key or the body is refused, or when no analysis of the
///         scene yields numbers that a sweep keeps.
SweepStudy sweep_study(const SweepRequest& request, const std::string& scene_file);

}  // namespace chladni::cases
