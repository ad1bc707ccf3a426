#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "common/error.hpp"
#include "scene/readers.hpp"

namespace chladni::scene {
namespace {

/// The stem of the files that the programs write; it must not lead out of their folder.
std::string read_name(const Table& root)
{
  if (!root.has("name")) return "disc";
  const std::string name = root.text("name");
  const std::string allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.find_first_not_of(allowed) != std::string::npos)
    root.refuse("name", "names files: only letters, digits, _ and -");
  return name;
}

/// Whether [response] asks the FE model.
bool answers_by_fe_model(const Table& root)
{
  if (!root.has("response")) return false;
  const Table response = root.table("response");
  return response.has("of") && response.text("of") == "fe";
}

/// A scene for `chladni static`, `chladni modes` or responses of the FE model alone needs no
/// reduction.
bool is_reduced(const Table& root, const Scene& scene, Purpose purpose)
{
  if (root.has("interface") || root.has("reduce")) return true;
  return purpose == Purpose::everything && !scene.static_solution && !scene.natural_modes &&
         !answers_by_fe_model(root);
}

/// The table "reduce", or of the list "spring" the second one, "spring[2]".
std::optional<Table> table_at(const Table& table, std::string_view step)
{
  const std::size_t bracket = step.find('[');
  const std::string_view name = step.substr(0, bracket);
  if (!table.has(name)) return std::nullopt;
  if (bracket == std::string_view::npos) return table.table(name);
  std::size_t place = 0;
  std::from_chars(step.data() + bracket + 1, step.data() + step.size(), place);
  const std::vector<Table> tables = table.tables(name);
  if (place < 1 || place > tables.size()) return std::nullopt;
  return tables[place - 1];
}

template <class Section>
bool is_lossy(const Section& section)
{
  return section.loss_factor.value_or(section.material.loss_factor) > 0.0;
}

/// Whether the model has dampers or loss factors.
bool damps(const Scene& scene)
{
  const auto& matrices = scene.mesh.matrices;
  return (matrices && (matrices->damping || matrices->structural_damping)) ||
         std::ranges::any_of(scene.sections, is_lossy<plate::ShellSection>) ||
         std::ranges::any_of(scene.beams, is_lossy<plate::BeamSection>) ||
         std::ranges::any_of(scene.solids, is_lossy<plate::SolidSection>) ||
         std::ranges::any_of(scene.springs, [](const plate::Spring& spring) {
           return spring.damping != std::array<double, 6>{} || spring.loss_factor > 0.0;
         });
}

/// What the notes of the tables leave open: stiffening of beams under a tolerance, which does not
/// see the error of their stress.
std::vector<std::string> notes_of(const Table& root, const Scene& scene)
{
  std::vector<std::string> notes = root.notes();
  const bool has_tolerance = scene.reduce.tolerance || scene.body.keep.tolerance;
  if (has_tolerance && !scene.stiffening.empty() && !scene.beams.empty()) {
    notes.push_back(fmt::format(
        "{}: reduce.stiffening: the axial force of a beam of order p is of degree p - 1; the "
        "tolerance does not include the resulting error of the stiffened frequencies, which falls "
        "with the square of the length of two-node beams: compare with shorter or higher ones",
        scene.path));
  }
  return notes;
}

/// What needs elements.
void refuse_beside_matrices(const Table& root, const Scene& scene)
{
  if (!scene.mesh.matrices) return;
  constexpr const char* needs_elements = "needs elements of our own; mesh.matrices has none";
  if (scene.accuracy) root.refuse("accuracy", needs_elements);
  if (scene.natural_modes && scene.natural_modes->mesh_errors)
    root.table("modes").refuse("mesh_errors", needs_elements);
  if (!root.has("reduce")) return;
  for (const char* key : {"mesh_errors", "resultants", "stiffening"})
    if (root.table("reduce").has(key)) root.table("reduce").refuse(key, needs_elements);
}

/// What is made of a reduced system.
void read_what_follows(const Table& root, Scene& scene)
{
  scene.body = read_body(root, scene);
  scene.response = read_response(root, scene);
  scene.squeal = read_squeal(root, scene);
  scene.radiation = read_radiation(root);
  scene.sound = read_sound(root, scene);
}

/// A scene without a mesh: its reduced system is another program's.
Scene read_imported(const Table& root, Scene scene)
{
  scene.has_mesh = false;
  scene.interface_nodes = read_interface(root, scene);
  read_what_follows(root, scene);
  root.refuse_unknown_keys();
  scene.notes = root.notes();
  return scene;
}

/// The scene of the tables; `scene` holds text, path and, where they are known, the groups of the
/// mesh file.
Scene read_tables(const Table& root, Scene scene, Purpose purpose)
{
  scene.name = read_name(root);
  scene.title = root.has("title") ? root.text("title") : scene.name;
  scene.squeal_model = read_squeal_model(root);
  if (scene.squeal_model) {
    root.refuse_unknown_keys();
    scene.notes = root.notes();
    return scene;
  }
  if (!root.has("mesh") && root.has("body") && !root.has("section") && !root.has("reduce"))
    return read_imported(root, std::move(scene));
  scene.accuracy = read_accuracy(root);
  scene.mesh = read_mesh(root, scene.path);
  const Sections sections = read_sections(root, scene);
  scene.components = read_model_components(root, sections);
  scene.sections = sections.shells;
  scene.beams = sections.beams;
  scene.solids = sections.solids;
  for (const plate::BeamSection& beam : scene.beams) scene.mesh.line_groups.push_back(beam.group);
  for (const auto& shell : scene.sections) scene.mesh.shell_groups.push_back(shell.group);
  for (const auto& solid : scene.solids) scene.mesh.solid_groups.push_back(solid.group);
  scene.couplings = read_couplings(root, scene);
  for (const plate::Coupling& coupling : scene.couplings) {
    if (coupling.kind == plate::CouplingKind::averaging) continue;
    scene.mesh.coupled_groups.push_back(coupling.group);
    if (!coupling.to.empty()) scene.mesh.coupled_groups.push_back(coupling.to);
  }
  scene.masses = read_masses(root, scene);
  scene.springs = read_springs(root, scene);
  read_deviations(root, scene);
  scene.supports = read_supports(root, scene);
  scene.loads = read_loads(root, scene);
  scene.static_solution = read_static(root, scene);
  scene.natural_modes = read_natural_modes(root);
  if (is_reduced(root, scene, purpose)) {
    scene.interface_nodes = read_interface(root, scene);
    scene.ring_harmonics = read_ring_harmonics(root, scene);
    scene.reduce = read_reduce(root, scene.accuracy);
    scene.ranks_per_harmonic = read_ranks_per_harmonic(root);
    scene.mesh_errors = read_mesh_errors(root, scene.accuracy);
    scene.resultants = read_resultants(root, scene);
    scene.pictures = read_pictures(root);
    scene.mass_integrals = read_mass_integrals(root);
    scene.stiffening = read_stiffening(root, scene);
    scene.sylvester = read_sylvester(root);
  }
  refuse_beside_matrices(root, scene);
  read_what_follows(root, scene);
  // Dampers and loss factors of the model are not lost when the body says nothing of damping.
  const bool said = root.has("body") && root.table("body").has("damping");
  if (!said && damps(scene)) scene.body.damping.type = mbs_export::Damping::Type::matrix;
  root.refuse_unknown_keys();
  scene.notes = notes_of(root, scene);
  return scene;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& path, Purpose purpose)
{
  Scene scene;
  scene.text = text;
  scene.path = path;
  return read_tables(parse_toml(text, path), std::move(scene), purpose);
}

void check_groups(const Scene& scene, const std::vector<std::string>& groups)
{
  Scene again;
  again.text = scene.text;
  again.path = scene.path;
  again.file_groups = groups;
  read_tables(parse_toml(scene.text, scene.path), std::move(again), Purpose::fe_model);
}

void refuse_key(const Scene& scene, const std::string& key, const std::string& why)
{
  Table table = parse_toml(scene.text, scene.path);
  std::string_view rest = key;
  for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
    const auto inner = table_at(table, rest.substr(0, dot));
    if (!inner) break;
    table = *inner;
    rest.remove_prefix(dot + 1);
  }
  if (table.has(rest)) table.refuse(rest, why);
  throw Error(fmt::format("{}: {}: {}", scene.path, key, why));
}

namespace {

/// What is no scene for a reason that can be told.
void refuse_other_files(const std::string& path)
{
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("{}: {}", path, why));
  };
  if (!fs::exists(path)) refuse("no such file; give a scene file (TOML)");
  if (fs::is_directory(path)) refuse("is a folder; give a scene file (TOML)");
  if (fs::is_regular_file(path) && fs::file_size(path) == 0) refuse("the scene file is empty");
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".h5")
    refuse("is a result file, but a scene file (TOML) is needed; `info` prints what it contains");
  if (mesh::is_deck(path)) {
    refuse(
        "is a deck of another program, but a scene file (TOML) is needed; `chladni import` writes "
        "one");
  }
  if (mesh::mesh_source(path))
    refuse("is a mesh, but a scene file (TOML) is needed; name the mesh there as `file` of [mesh]");
  const std::string instead = mesh::instead_of(path);
  if (!instead.empty())
    refuse("is a mesh of another program, but a scene file (TOML) is needed" + instead);
  if (extension == ".vtk") {
    refuse(
        "is a mesh of another program, but a scene file (TOML) is needed; name it there as `file` "
        "of [mesh] after `gmsh FILE -save -o mesh.msh`");
  }
}

}  // namespace

Scene read_scene(const std::string& path, Purpose purpose)
{
  refuse_other_files(path);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || !text) throw Error(fmt::format("{}: the scene file cannot be read", path));
  return parse_scene(text.str(), path, purpose);
}

Scene read_meshed_scene(const std::string& path, Purpose purpose)
{
  Scene scene = read_scene(path, purpose);
  if (!scene.squeal_model) return scene;
  throw Error(fmt::format("{0}: squeal.model has no mesh: run it with `squeal run {0}`", path));
}

}  // namespace chladni::scene
