#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/document.hpp"
#include "scene/scene.hpp"

/// The readers of the scene's tables. Each takes the root table and the part of the scene that was
/// read before it, so that names which refer to other tables can be checked.
namespace chladni::scene {

/// `accuracy`
std::optional<Accuracy> read_accuracy(const Table& root);

/// [mesh]; `scene_path` resolves a mesh file that is given relative to the scene. With `accuracy`
/// the size of its elements stays open.
mesh::MeshOptions read_mesh(const Table& root, const std::string& scene_path);

/// [model] dofs: the components of each node; without the table all six.
std::vector<int> read_model_components(const Table& root);

/// The sections by type.
struct Sections {
  std::vector<plate::ShellSection> shells;
  std::vector<plate::BeamSection> beams;
};

/// [[section]] with the [material.NAME] that they name; needs the mesh of `scene`.
Sections read_sections(const Table& root, const Scene& scene);

/// [[coupling]]
std::vector<plate::Coupling> read_couplings(const Table& root, const Scene& scene);

/// [[mass]] and [[spring]]; their places may be groups, rings and couplings of `scene`.
std::vector<plate::PointMass> read_masses(const Table& root, const Scene& scene);
std::vector<plate::Spring> read_springs(const Table& root, const Scene& scene);

/// A table of [[mass]] or of [[spring]].
plate::PointMass read_mass(const Table& table, const Scene& scene);
plate::Spring read_spring(const Table& table, const Scene& scene);

/// A constant, a table over a coordinate or the radius, or a formula, which the mesh will check.
plate::Profile read_profile(const Table& section, std::string_view key);

/// The [material.NAME] that a table names.
plate::Material read_material_of(const Table& table, const Table& root);

/// Puts [[deviation]] into a scene that has all of its model otherwise: where one sector is meshed
/// beside the sections, else in their place.
void read_deviations(const Table& root, Scene& scene);

/// [[support]]; needs the mesh and the couplings of `scene`.
std::vector<plate::Support> read_supports(const Table& root, const Scene& scene);

/// [[load]]; as the supports.
std::vector<plate::Load> read_loads(const Table& root, const Scene& scene);

/// [static]; as the supports.
std::optional<StaticOptions> read_static(const Table& root, const Scene& scene);

/// [modes]
std::optional<ModesOptions> read_natural_modes(const Table& root);

/// [interface] nodes; needs the mesh and the couplings of `scene`.
std::vector<std::string> read_interface(const Table& root, const Scene& scene);

/// [interface] rings; needs the nodes of the interface, too.
std::vector<plate::RingHarmonics> read_ring_harmonics(const Table& root, const Scene& scene);

/// [reduce] without its keys `pictures`, `resultants`, `resultant_elements`,
/// `mass_integrals`, `mesh_errors`, `ranks_per_harmonic`, `stiffening` and `sylvester`; with
/// `accuracy` by its tolerance.
reduce::ReduceOptions read_reduce(const Table& root, const std::optional<Accuracy>& accuracy);

/// [reduce] ranks_per_harmonic
std::optional<int> read_ranks_per_harmonic(const Table& root);

/// [reduce] mesh_errors
bool read_mesh_errors(const Table& root, const std::optional<Accuracy>& accuracy);

/// [reduce] resultants, resultant_elements; needs the sections of `scene`.
ResultantChoice read_resultants(const Table& root, const Scene& scene);

/// [reduce] pictures
PictureChoice read_pictures(const Table& root);

/// [reduce] mass_integrals
bool read_mass_integrals(const Table& root);

/// [reduce] stiffening; needs the components of `scene`.
std::vector<std::string> read_stiffening(const Table& root, const Scene& scene);

/// [reduce] sylvester
std::optional<bool> read_sylvester(const Table& root);

/// [body]; without the table the body is free and keeps all modes, with `accuracy` those of its
/// tolerance. Reads `accuracy`, `interface_nodes` and
/// `reduce` of the scene.
mbs_export::BodyOptions read_body(const Table& root, const Scene& scene);

/// [response]; needs the mesh, the couplings, the interface and the resultants of `scene`.
std::optional<mbs_export::ResponseOptions> read_response(const Table& root, const Scene& scene);

/// [squeal]; needs the mesh and the interface of `scene`.
std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene);

/// [squeal] radiation
bool read_radiation(const Table& root);

/// [sound]; needs the mesh, the sections and the squeal of `scene`.
std::optional<sound::SoundOptions> read_sound(const Table& root, const Scene& scene);

/// [squeal] of a scene whose `model` is a rigid disc, a mass on a moving surface or an assembly,
/// which has no mesh and no body of its own; absent for any other scene.
std::optional<squeal::ModelOptions> read_squeal_model(const Table& root);

/// The names of the rings of a mesh.
const std::vector<mesh::RingOptions>& rings_of(const mesh::MeshOptions& mesh);
std::vector<std::string> ring_names(const mesh::MeshOptions& mesh);

/// The groups of a scene's mesh, its rings among them; empty for a mesh file that was not read yet.
std::vector<std::string> group_names(const Scene& scene);

/// What may be held, loaded or observed in the FE model: groups, rings and couplings; empty where
/// the mesh file was not read yet.
std::vector<std::string> named_sets(const Scene& scene);

/// Those groups that are surfaces, or lines of a generated beam.
std::vector<std::string> surface_groups(const mesh::MeshOptions& mesh);

/// One number for each component that the table `key = { z = ..., ry = ... }` names, else 0.
std::array<double, 6> read_by_component(const Table& table, std::string_view key);

/// A list of three numbers.
std::array<double, 3> read_vector(const Table& table, std::string_view key);

/// A list of components by name as numbers 0 to 5, in the order of the list.
std::vector<int> read_component_list(const Table& table, std::string_view key);

/// A list of mode numbers, counted from 1, ascending.
std::vector<int> read_mode_list(const Table& table, std::string_view key);

}  // namespace chladni::scene
