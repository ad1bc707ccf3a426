#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/document.hpp"
#include "scene/scene.hpp"
#include "squeal/assembly_options.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/study_options.hpp"

/// Readers of the scene's tables. Each takes the root table and the part of the scene that was read
/// before, to check names that refer to other tables. All throw chladni::Error with file, line, key
/// and value when a value is not accepted.

namespace chladni::scene {

/// Reads `accuracy`.
std::optional<Accuracy> read_accuracy(const Table& root);

/// Reads [mesh]. A relative path of a mesh file is relative to the scene. With `accuracy` the
/// element size is left open.
mesh::MeshOptions read_mesh(const Table& root, const std::string& scene_path);

/// Sections of shells, beams and solids.
struct Sections {
  std::vector<plate::ShellSection> shells;
  std::vector<plate::BeamSection> beams;
  std::vector<plate::SolidSection> solids;
};

/// Reads dofs of [model], the DOF components of each node; without the table all six, of which
/// solids have x, y, z alone.
std::vector<int> read_model_components(const Table& root, const Sections& sections);

/// Reads [[section]] with the [material.NAME] that each names; needs the mesh of `scene`.
Sections read_sections(const Table& root, const Scene& scene);

/// Reads [[coupling]].
std::vector<plate::Coupling> read_couplings(const Table& root, const Scene& scene);

/// Reads [[mass]] and [[spring]]; their places may be groups, rings and couplings of `scene`.
std::vector<plate::PointMass> read_masses(const Table& root, const Scene& scene);
std::vector<plate::Spring> read_springs(const Table& root, const Scene& scene);

/// Reads one table of [[mass]] or of [[spring]].
plate::PointMass read_mass(const Table& table, const Scene& scene);
plate::Spring read_spring(const Table& table, const Scene& scene);

/// Reads a profile: a constant, a table over a coordinate or the radius, or a formula. The formula
/// is checked when the mesh is known.
plate::Profile read_profile(const Table& section, std::string_view key);

/// Reads the [material.NAME] that a table names.
plate::Material read_material_of(const Table& table, const Table& root);

/// Adds [[deviation]] to an otherwise complete scene: to the list of deviations when one sector is
/// meshed, else as changed sections of the whole body.
void read_deviations(const Table& root, Scene& scene);

/// Reads [[support]]; needs the mesh and the couplings of `scene`.
std::vector<plate::Support> read_supports(const Table& root, const Scene& scene);

/// Reads [[load]]; needs the mesh and the couplings of `scene`.
std::vector<plate::Load> read_loads(const Table& root, const Scene& scene);

/// Reads [static]; needs the mesh and the couplings of `scene`.
std::optional<StaticOptions> read_static(const Table& root, const Scene& scene);

/// Reads [modes].
std::optional<ModesOptions> read_natural_modes(const Table& root);

/// Reads nodes of [interface]; needs the mesh and the couplings of `scene`.
std::vector<std::string> read_interface(const Table& root, const Scene& scene);

/// Reads rings of [interface]; needs the mesh, the couplings and the interface nodes of `scene`.
std::vector<plate::RingHarmonics> read_ring_harmonics(const Table& root, const Scene& scene);

/// Reads [reduce] without its keys `pictures`, `resultants`, `resultant_elements`,
/// `mass_integrals`, `mesh_errors`, `ranks_per_harmonic`, `stiffening` and `sylvester`. With
/// `accuracy` its tolerance is used.
reduce::ReduceOptions read_reduce(const Table& root, const std::optional<Accuracy>& accuracy);

/// Reads ranks_per_harmonic of [reduce].
std::optional<int> read_ranks_per_harmonic(const Table& root);

/// Reads mesh_errors of [reduce].
bool read_mesh_errors(const Table& root, const std::optional<Accuracy>& accuracy);

/// Reads resultants and resultant_elements of [reduce]; needs the sections of `scene`.
ResultantChoice read_resultants(const Table& root, const Scene& scene);

/// Reads pictures of [reduce].
PictureChoice read_pictures(const Table& root);

/// Reads mass_integrals of [reduce].
bool read_mass_integrals(const Table& root);

/// Reads stiffening of [reduce]; needs the components of `scene`.
std::vector<std::string> read_stiffening(const Table& root, const Scene& scene);

/// Reads sylvester of [reduce].
std::optional<bool> read_sylvester(const Table& root);

/// Reads [body]. Without the table the body is free and keeps all modes, or with `accuracy` those
/// of its tolerance. Needs `accuracy`, `interface_nodes` and `reduce` of the scene.
mbs_export::BodyOptions read_body(const Table& root, const Scene& scene);

/// Reads [response]; needs the mesh, the couplings, the interface and the resultants of `scene`.
std::optional<mbs_export::ResponseOptions> read_response(const Table& root, const Scene& scene);

/// Reads [squeal]; needs the mesh and the interface of `scene`.
std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene);

/// Reads radiation of [squeal].
bool read_radiation(const Table& root);

/// Reads [sound]; needs the mesh, the sections and the squeal of `scene`.
std::optional<sound::SoundOptions> read_sound(const Table& root, const Scene& scene);

/// Reads [squeal] of a scene whose `model` is a rigid disc, masses on a moving surface or an
/// assembly, without a mesh and a body of its own; absent for other scenes.
std::optional<squeal::ModelOptions> read_squeal_model(const Table& root);

/// The rings of a mesh.
const std::vector<mesh::RingOptions>& rings_of(const mesh::MeshOptions& mesh);
/// The names of the rings of a mesh.
std::vector<std::string> ring_names(const mesh::MeshOptions& mesh);

/// The groups of a scene's mesh, including its rings; empty for a mesh file that was not read yet.
std::vector<std::string> group_names(const Scene& scene);

/// Names that supports, loads and outputs of the FE model may refer to: groups, rings and
/// couplings; empty for a mesh file that was not read yet.
std::vector<std::string> named_sets(const Scene& scene);

/// The groups of the mesh that are surfaces, or lines of a generated beam.
std::vector<std::string> surface_groups(const mesh::MeshOptions& mesh);

/// Reads `key = { z = ..., ry = ... }`: one number for each component, 0 for those not named.
std::array<double, 6> read_by_component(const Table& table, std::string_view key);

/// Reads a list of three numbers.
std::array<double, 3> read_vector(const Table& table, std::string_view key);

/// Reads a list of component names as numbers 0 to 5, in the order of the list.
std::vector<int> read_component_list(const Table& table, std::string_view key);

/// Reads a list of ascending mode numbers, counted from 1.
std::vector<int> read_mode_list(const Table& table, std::string_view key);

}  // namespace chladni::scene

/// Readers that all models of [squeal] share. All throw chladni::Error as the functions of Table.

namespace chladni::scene {

/// Reads `friction` of [squeal] or of a pad: one coefficient, a table with `kinetic`, `static`,
/// `decay_speed` and `regularisation`, or measured values in `table`.
squeal::FrictionLaw read_friction(const Table& of);

/// Reads `friction` for a model that does not support measured values.
squeal::FrictionLaw read_plain_friction(const Table& squeal);

/// Reads contact of [squeal]; unilateral when it is missing.
squeal::ContactLaw read_contact(const Table& squeal);

/// Reads the spring of a pad from its keys `stiffness` and `cubic_stiffness`.
squeal::PadSpring read_pad_spring(const Table& pad);

/// Reads [[part]], [[joint]], [[contact]] and the keys of [squeal] for an assembly.
squeal::AssemblyOptions read_assembly(const Table& root);

/// Reads pads of [squeal] for a flexible disc.
std::vector<squeal::PadPair> read_pads(const Table& squeal);

/// Whether the study has a modal body; some analyses need one.
enum class StudyOf { body, model };

/// Reads the keys of [squeal] that select and configure the analyses.
squeal::StudyOptions read_study(const Table& squeal, StudyOf of);

/// Reads limit_cycle_direct of [squeal]; its speed is that of the transient unless it is given.
std::optional<squeal::DirectCase> read_direct(
    const Table& squeal, const std::optional<squeal::TransientCase>& transient);

/// Reads rotation_stability of [squeal]; Hill's method when it is missing.
squeal::RotationMethod read_rotation_method(const Table& squeal);

/// Reads critical of [squeal].
std::vector<squeal::CriticalCase> read_critical(const Table& squeal, StudyOf of);

/// Reads map of [squeal].
std::optional<squeal::MapCase> read_map(const Table& squeal, StudyOf of);

/// Reads stability of [squeal], which covers the speeds of the study unless it says otherwise.
std::optional<squeal::StabilityCase> read_stability(const Table& squeal,
                                                    const squeal::SpeedRange& speeds, StudyOf of);

}  // namespace chladni::scene
