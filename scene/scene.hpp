#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/responses/response_options.hpp"
#include "mesh/mesh_options.hpp"
#include "plate/load_options.hpp"
#include "plate/plate_options.hpp"
#include "reduce/reduce_options.hpp"
#include "sound/sound_options.hpp"
#include "squeal/model_options.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::scene {

/// Of which nodes the reduced file keeps the displacements, for pictures.
enum class PictureChoice { none, vertices, all };

/// Of which elements the section forces are kept, as linear forms in the coordinates.
struct ResultantChoice {
  std::vector<std::string> groups;
  std::vector<int>
      elements;  ///< of the groups only these, by their numbers in the mesh; empty: all
};

/// `chladni static`: whose displacements the summary lists.
struct StaticOptions {
  std::vector<std::string> report;  ///< groups, rings or couplings
};

/// `chladni modes`
struct ModesOptions {
  int count = 10;            ///< natural modes, rigid-body motions included
  bool mesh_errors = false;  ///< estimate what the mesh lets their frequencies be off
};

/// What a scene asks for in place of a mesh and a reduction of its choice.
struct Accuracy {
  double error;     ///< of each natural frequency of the body under its supports, relative: of mesh
                    ///< and reduction together
  double up_to_Hz;  ///< of the frequencies that keep it
  bool chooses_order = true, chooses_edge_row = true;  ///< where [mesh] does not say them
};

/// What some sectors of a body have other than the rest of them; one of the three.
struct Deviation {
  std::vector<int> sectors;  ///< the meshed one is 0, the next about z is 1; empty: all
  /// In the place of its group's section; profiles run over places of the whole body.
  std::optional<plate::ShellSection> section;
  /// Besides those of all sectors; components as in the meshed sector, turned with it.
  std::optional<plate::PointMass> mass;
  std::optional<plate::Spring> spring;
};

/// A scene file, read and checked: one case from the mesh to the squeal.
struct Scene {
  std::string name;  ///< stem of the files that the programs write
  std::string title;
  std::string text;                ///< of the file, for provenance
  std::string path;                ///< of the file
  std::vector<std::string> notes;  ///< for the user: numbers that look like another unit's
  std::optional<Accuracy> accuracy;
  /// With `accuracy` a generator's element size of 0, and of a file a size factor of none, are
  /// still to be chosen.
  mesh::MeshOptions mesh;
  std::vector<std::string> file_groups;  ///< of the mesh file; empty before it is read
  /// Of each node; the others are held at zero and not part of the model.
  std::vector<int> components = {0, 1, 2, 3, 4, 5};
  std::vector<plate::ShellSection> sections;
  std::vector<plate::BeamSection> beams;
  std::vector<plate::PointMass> masses;
  std::vector<plate::Spring> springs;
  std::vector<Deviation> deviations;  ///< of a body of which one sector is meshed
  std::vector<plate::Coupling> couplings;
  std::vector<plate::Support> supports;  ///< of `static` and `modes`; the reduction has none
  std::vector<plate::Load> loads;        ///< of `static`
  std::optional<StaticOptions> static_solution;
  std::optional<ModesOptions> natural_modes;
  std::vector<std::string> interface_nodes;  ///< rings, couplings or groups, all DOFs of each node;
                                             ///< empty in a scene for `static` or `modes` alone
  std::vector<plate::RingHarmonics> ring_harmonics;  ///< of interface nodes that are rings
  PictureChoice pictures = PictureChoice::vertices;
  ResultantChoice resultants;
  reduce::ReduceOptions reduce;
  /// Of a body of equal sectors; without it as many as there are for each harmonic.
  std::optional<int> ranks_per_harmonic;
  bool mesh_errors = false;    ///< estimate what the mesh lets the body's frequencies be off
  bool mass_integrals = true;  ///< of a moving frame: Coriolis and centrifugal forces
  std::vector<std::string> stiffening;  ///< words: motions whose stress is to stiffen the body
  std::optional<bool> sylvester;  ///< count eigenvalues of the FE model; empty: if that is cheap
  mbs_export::BodyOptions body;
  std::optional<mbs_export::ResponseOptions> response;
  std::optional<squeal::SquealOptions> squeal;
  bool radiation = false;  ///< `squeal` damps the modes by the sound that they radiate
  std::optional<sound::SoundOptions> sound;
  std::optional<squeal::ModelOptions> squeal_model;  ///< without a mesh: all else is empty
};

/// What a scene is read for; its FE model alone needs neither [interface] nor [reduce].
enum class Purpose { everything, fe_model };

/// The scene of a TOML text; `path` names it in messages, and its folder is where mesh files are.
/// @throws chladni::Error naming file, line, key and value of what is wrong, and what is allowed.
Scene parse_scene(const std::string& text, const std::string& path,
                  Purpose purpose = Purpose::everything);

/// The scene of a file.
/// @throws chladni::Error as parse_scene, and when the file cannot be read.
Scene read_scene(const std::string& path, Purpose purpose = Purpose::everything);

/// Refuses the first key that names a group which the mesh file does not have.
/// @param groups  names of the groups and rings of the mesh that was read
/// @throws chladni::Error naming file, line, key and value, and the groups that there are.
void check_groups(const Scene& scene, const std::vector<std::string>& groups);

/// Refuses the value of a key ("body.keep.modes"; "spring[2].damping" in the second table of a
/// list) that turns out wrong after the reading.
/// @throws chladni::Error naming file, line, key and value.
[[noreturn]] void refuse_key(const Scene& scene, const std::string& key, const std::string& why);

/// The scene of a file, for a program that needs its mesh or its body.
/// @throws chladni::Error as read_scene, and when the scene's model has neither.
Scene read_meshed_scene(const std::string& path, Purpose purpose = Purpose::everything);

}  // namespace chladni::scene
