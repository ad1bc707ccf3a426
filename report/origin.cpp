#include "report/origin.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <vector>

#include "common/error.hpp"
#include "common/files/input_file.hpp"
#include "report/text_table.hpp"
#include "scene/scene_text.hpp"

namespace chladni::report {

std::string digest_of_mesh_files(const scene::Scene& scene)
{
  const mesh::MeshOptions& mesh = scene.mesh;
  if (!mesh.file) return "";
  std::vector<std::string> names{*mesh.file};
  if (mesh.matrices) {
    names.insert(names.end(), {mesh.matrices->stiffness, mesh.matrices->mass});
    for (const auto* file :
         {&mesh.matrices->damping, &mesh.matrices->structural_damping, &mesh.matrices->dofs})
      if (*file) names.push_back(**file);
  }
  std::string all;
  for (const std::string& file : names) {
    const std::string digest = files::file_digest(file);
    if (digest.empty()) return "";
    all += digest;
  }
  return all;
}

namespace {

/// The scenes that a file was made from, step by step; empty where a step has none.
struct Texts {
  std::string reduction, body, results, radiation, sound;
};

Texts texts_of(const Read& read)
{
  const mbs_export::Provenance& origin = read.origin;
  const auto first = [](const std::string& one, const std::string& other) {
    return one.empty() ? other : one;
  };
  switch (read.what) {
    case Made::reduction:
      return {.reduction = origin.scene, .body = {}, .results = {}, .radiation = {}, .sound = {}};
    case Made::body:
      return {.reduction = first(origin.reduction_scene, origin.scene),
              .body = origin.scene,
              .results = {},
              .radiation = {},
              .sound = {}};
    case Made::results:
    case Made::radiation:
    case Made::sound:
      break;
  }
  const bool radiates = read.what == Made::radiation;
  return {.reduction = first(origin.reduction_scene, origin.body_scene),
          .body = origin.body_scene,
          .results = radiates ? std::string() : origin.scene,
          .radiation = radiates ? origin.scene : std::string(),
          .sound = read.what == Made::sound ? origin.scene : std::string()};
}

/// "the mesh file disc.msh" when it is there and is not what it was.
std::vector<std::string> changed_mesh(const scene::Scene& scene,
                                      const mbs_export::Provenance& origin)
{
  if (origin.mesh_file_digest.empty() || !scene.mesh.file) return {};
  const std::string digest = digest_of_mesh_files(scene);
  if (digest.empty() || digest == origin.mesh_file_digest) return {};
  return {fmt::format("the mesh file {}{}", *scene.mesh.file,
                      scene.mesh.matrices ? " or its matrices" : "")};
}

/// What has changed, and what to run again.
struct Verdict {
  std::vector<std::string> changes;
  std::string remedy;
};

void add(std::vector<std::string>& all, const std::vector<std::string>& more)
{
  all.insert(all.end(), more.begin(), more.end());
}

std::string remedy_of(Made changed, const Read& read, const std::string& scene)
{
  const std::string folder = read.file.parent_path().string();
  const std::string words =
      fmt::format("{} --output {}", scene, folder.empty() ? std::string(".") : folder);
  if (changed == Made::sound) return fmt::format("`chladni sound {}`", words);
  if (read.what == Made::radiation) return fmt::format("`chladni sound {} --radiation`", words);
  const std::string last =
      read.what == Made::sound ? fmt::format(" and `chladni sound {}`", words) : std::string();
  if (changed == Made::results) return fmt::format("`squeal run {}`{}", words, last);
  const char* program = read.what == Made::reduction ? "reduce"
                        : changed == Made::reduction ? "run"
                                                     : "body";
  const std::string first = fmt::format("`chladni {} {}`", program, words);
  if (read.what == Made::sound) return fmt::format("{}, `squeal run {}`{}", first, words, last);
  return read.what == Made::results ? first + fmt::format(" and `squeal run {}`", words) : first;
}

Verdict verdict_on(const scene::Scene& scene, const Read& read)
{
  using scene::Step;
  const Texts texts = texts_of(read);
  Verdict verdict;
  add(verdict.changes, scene::changed_keys(texts.results, scene.text, Step::squeal));
  const bool is_sound_alone = read.what == Made::sound && verdict.changes.empty();
  Made first = is_sound_alone ? Made::sound : Made::results;
  add(verdict.changes, scene::changed_keys(texts.radiation, scene.text, Step::radiation));
  add(verdict.changes, scene::changed_keys(texts.sound, scene.text, Step::sound));
  const auto look_at = [&](const std::vector<std::string>& changes, Made what) {
    if (!changes.empty()) first = what;
    add(verdict.changes, changes);
  };
  look_at(scene::changed_keys(texts.body, scene.text, Step::body), Made::body);
  look_at(scene::changed_keys(texts.reduction, scene.text, Step::reduction), Made::reduction);
  look_at(changed_mesh(scene, read.origin), Made::reduction);
  verdict.remedy = remedy_of(first, read, scene.path);
  return verdict;
}

std::string list_of(const std::vector<std::string>& changes)
{
  constexpr std::size_t shown = 4;
  const std::size_t n = std::min(shown, changes.size());
  const std::string list =
      fmt::format("{}", fmt::join(changes.begin(), changes.begin() + std::ptrdiff_t(n), ", "));
  const std::size_t others = changes.size() - n;
  return others > 0 ? fmt::format("{} and {} more", list, others) : list;
}

}  // namespace

void require_of_scene(const scene::Scene& scene, const Read& read, Stale stale)
{
  const Verdict verdict = verdict_on(scene, read);
  if (verdict.changes.empty()) return;
  const std::string what = fmt::format("{} was made before these changes of {}: {}",
                                       read.file.string(), scene.path, list_of(verdict.changes));
  if (stale == Stale::refuse) {
    throw Error(fmt::format("{}; make it anew by {}, or take it as it is with --stale", what,
                            verdict.remedy));
  }
  fmt::print(stderr, "{}\n", printable(what));
}

}  // namespace chladni::report
