#include "cases/squeal/sweep_study.hpp"

#include <fmt/format.h>

#include <utility>

#include "cases/squeal/sweep_columns.hpp"
#include "common/error.hpp"

namespace chladni::cases {
namespace {

/// The analyses of each variant.
/// @throws chladni::Error when the scene has none of which a sweep keeps a number.
std::vector<std::string> analyses_of(const SweepRequest& request, const scene::Scene& scene)
{
  if (!request.analyses.empty()) return request.analyses;
  std::vector<std::string> analyses = study_of(scene).analyses;
  std::erase_if(analyses, [](const std::string& name) { return !has_sweep_columns(name); });
  if (analyses.empty()) {
    throw Error(
        fmt::format("{}: no analysis of the scene yields single numbers; choose others with "
                    "--analyses, as in --analyses critical-speed",
                    scene.path));
  }
  return analyses;
}

}  // namespace

SweepStudy sweep_study(const SweepRequest& request, const std::string& scene_file)
{
  const SweepValues& wanted = request.values;
  const scene::Scene scene = scene::read_scene(request.scene);
  require_study(scene);
  std::vector<std::vector<scene::NumberPlace>> places;
  for (const std::string& key : wanted.keys)
    places.push_back(scene::places_of_squeal_key(scene, key));
  squeal::StudyOptions options = study_of(scene);
  options.analyses = analyses_of(request, scene);
  squeal::SweepTable table =
      squeal::empty_sweep(wanted.keys, wanted.values, sweep_columns(options));
  const SquealFiles files = squeal_files(scene, request.folder, request.body);
  const auto body = body_for_squeal(scene, files, request.stale);
  SquealCase brake_case = squeal_case(scene, body, files, request.stale);
  squeal::RunOrigin origin = squeal_origin(scene, body, files, scene_file);
  table.inputs = origin.inputs;
  const auto make_brake = [body, files](const scene::Scene& variant) {
    return std::shared_ptr<const squeal::Brake>(
        squeal_case(variant, body, files, std::nullopt).brake);
  };
  return {.sweep = {scene, options.analyses, std::move(places), std::move(brake_case.brake),
                    make_brake},
          .table = std::move(table),
          .origin = std::move(origin),
          .notes = std::move(brake_case.notes)};
}

}  // namespace chladni::cases
