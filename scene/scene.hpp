#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/responses/response_options.hpp"
#include "mesh/mesh_options.hpp"
#include "plate/plate_options.hpp"
#include "reduce/reduce_options.hpp"
#include "sound/sound_options.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/model_options.hpp"

namespace chladni::scene {

/// The nodes whose displacements the reduced file keeps for pictures.
enum class PictureChoice { none, vertices, all };

/// The elements whose section forces or stresses are kept, as linear forms in the coordinates.
struct ResultantChoice {
  std::vector<std::string> groups;
  std::vector<int> elements;  ///< numbers in the mesh, within the groups; empty: all
};

/// Options of `chladni static`.
struct StaticOptions {
  /// Groups, rings or couplings whose displacements the summary lists.
  std::vector<std::string> report;
};

/// Options of `chladni modes`.
struct ModesOptions {
  int count = 10;            ///< number of natural modes, including rigid-body modes
  bool mesh_errors = false;  ///< estimate the error of the frequencies due to the mesh
};

/// An accuracy from which mesh and reduction are chosen.
struct Accuracy {
  /// Relative error of each natural frequency of the body under its supports, from mesh and
  /// reduction together.
  double error;
  double up_to_Hz;  ///< upper limit of the frequencies that keep this error
  bool chooses_order = true, chooses_edge_row = true;  ///< whether [mesh] leaves them open
};

/// A deviation of some sectors of a body from the others: one of section, mass or spring.
struct Deviation {
  std::vector<int> sectors;  ///< the meshed sector is 0, the next about z is 1; empty: all sectors
  /// Replaces the section of its group. Profiles are functions of the place in the whole body.
  std::optional<plate::ShellSection> section;
  /// Added to those of all sectors; its components are those of the meshed sector, turned with it.
  std::optional<plate::PointMass> mass;
  std::optional<plate::Spring> spring;
};

/// A scene file, read and checked: one case from the mesh to the squeal.
struct Scene {
  std::string name;  ///< stem of the output files' names
  std::string title;
  std::string text;                ///< text of the file, for provenance
  std::string path;                ///< path of the file
  std::vector<std::string> notes;  ///< notes for the user: numbers that look as if in another unit
  std::optional<Accuracy> accuracy;
  /// With `accuracy`, an element size of 0 of a generator and a missing size factor of a file are
  /// chosen later.
  mesh::MeshOptions mesh;
  bool has_mesh = true;                  ///< false for a reduced system of another program
  std::vector<std::string> file_groups;  ///< groups of the mesh file; empty before it is read
  /// DOF components of each node; the others are held at zero and not part of the model.
  std::vector<int> components = {0, 1, 2, 3, 4, 5};
  std::vector<plate::ShellSection> sections;
  std::vector<plate::BeamSection> beams;
  std::vector<plate::SolidSection> solids;
  std::vector<plate::PointMass> masses;
  std::vector<plate::Spring> springs;
  std::vector<Deviation> deviations;  ///< of a body of which only one sector is meshed
  std::vector<plate::Coupling> couplings;
  std::vector<plate::Support> supports;  ///< for `static` and `modes`; the reduction has none
  std::vector<plate::Load> loads;        ///< for `static`
  std::optional<StaticOptions> static_solution;
  std::optional<ModesOptions> natural_modes;
  /// Rings, couplings or groups whose nodes are masters with all DOFs; empty in a scene for
  /// `static` or `modes` only.
  std::vector<std::string> interface_nodes;
  std::vector<plate::RingHarmonics> ring_harmonics;  ///< harmonics of interface rings
  PictureChoice pictures = PictureChoice::vertices;
  ResultantChoice resultants;
  reduce::ReduceOptions reduce;
  /// MPI ranks that share one harmonic of a body of equal sectors; empty: as few as the number of
  /// ranks allows.
  std::optional<int> ranks_per_harmonic;
  bool mesh_errors = false;    ///< estimate the error of the body's frequencies due to the mesh
  bool mass_integrals = true;  ///< integrals for a moving frame: Coriolis and centrifugal forces
  std::vector<std::string> stiffening;  ///< names of the motions whose stress stiffens the body
  /// Count the FE model's eigenvalues; empty: only when that is cheap.
  std::optional<bool> sylvester;
  mbs_export::BodyOptions body;
  std::optional<mbs_export::ResponseOptions> response;
  std::optional<squeal::SquealOptions> squeal;
  bool radiation = false;  ///< `squeal` adds the radiation damping of the modes
  std::optional<sound::SoundOptions> sound;
  /// For a scene without a mesh; all other parts are then empty.
  std::optional<squeal::ModelOptions> squeal_model;
};

/// What a scene is read for: everything, or its FE model, which needs neither [interface] nor
/// [reduce].
enum class Purpose { everything, fe_model };

/// The scene of a TOML text.
/// @param path  its name in messages; relative mesh files are looked up in its folder
/// @throws chladni::Error naming file, line, key and value of a mistake, and what is allowed.
Scene parse_scene(const std::string& text, const std::string& path,
                  Purpose purpose = Purpose::everything);

/// The scene of a file.
/// @throws chladni::Error as parse_scene, and when the file cannot be read.
Scene read_scene(const std::string& path, Purpose purpose = Purpose::everything);

/// Checks that the mesh has the groups that the scene names.
/// @param groups  names of the groups and rings of the mesh
/// @throws chladni::Error naming file, line, key and value of the first unknown group, and the
///         groups of the mesh.
void check_groups(const Scene& scene, const std::vector<std::string>& groups);

/// Refuses the value of a key that turns out to be wrong after reading, such as "body.keep.modes"
/// or "spring[2].damping" for the second table of a list.
/// @throws chladni::Error naming file, line, key and value.
[[noreturn]] void refuse_key(const Scene& scene, const std::string& key, const std::string& why);

/// The scene of a file, for a program that needs a mesh or a body.
/// @throws chladni::Error as read_scene, and when the scene has neither.
Scene read_meshed_scene(const std::string& path, Purpose purpose = Purpose::everything);

}  // namespace chladni::scene
