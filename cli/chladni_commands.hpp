#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/seal.hpp"
#include "cli/self_description.hpp"
#include "linear/solver_options.hpp"
#include "report/page/report.hpp"

/// The subcommands of the program `chladni`. Each prints its summary on the first rank, writes the
/// files at its end, and throws chladni::Error when the job failed, before anything is written.
/// @note Collective on all ranks.
namespace chladni::cli {

/// What `chladni export` takes.
struct ExportArguments {
  std::string source;      ///< a scene or a *.reduced.h5
  std::string format;      ///< one of export_formats()
  std::string from = ".";  ///< folder of the scene's reduced system
  std::string output;      ///< the file to write; empty for NAME and the extension of the format
  int superelement = 100;  ///< its number in Nastran
  std::string sid_dialect = "simpack";     ///< one of sid_dialects()
  std::string sid_gyroscopic = "by-mode";  ///< one of sid_gyroscopic_orders()
  std::string fmi = "2";                   ///< version of FMI: one of fmi_versions()
  std::vector<std::string> nodes;          ///< sets of attachment nodes of an FMU; empty: all
  std::string json;                        ///< file for the summary; empty for none
  bool stale = false;  ///< a reduced file made before a change of the scene is taken as it is
};

/// What `chladni import` takes.
struct ImportArguments {
  std::string deck;         ///< of Nastran or Abaqus
  std::string length_unit;  ///< what 1 is in it: "mm"
  std::string force_unit;   ///< of its moduli: "N"; empty: N, or lbf where lengths are inches
  std::string output;       ///< the scene to write; empty for stdout
};

/// What `chladni mesh` takes besides; SCENE may be a mesh file there.
struct QualityChoice {
  bool quality = false;     ///< report the shapes of the elements
  std::string length_unit;  ///< what 1 is in a file without a scene that does not tell it
};

/// What `chladni sound` takes besides.
struct SoundChoice {
  bool radiation_only = false;  ///< damping of the modes, without a limit cycle
};

/// What `chladni response` takes besides.
struct ResponseChoice {
  std::string universal_file;  ///< to write; empty for none
};

/// What `chladni mac` takes.
struct MacArguments {
  std::string body;         ///< *.body.h5
  std::string measured;     ///< a universal file
  double distance = 0.0;    ///< m, from a measured node to one of the body
  std::string length_unit;  ///< of a measurement that does not say its own
  std::string json;         ///< file for the summary; empty for none
};

struct ChladniArguments {
  SceneArguments scene;
  bool trusts_mesh = false;  ///< the mesh file is the user's own and may run programs
  QualityChoice mesh;
  SoundChoice sound;
  ResponseChoice response;
  MacArguments mac;
  std::string info_file;
  std::string check_file;
  std::string check_json;  ///< file for the summary; empty for none
  SealArguments seal;
  SelfDescription self;
  ExportArguments exported;
  ImportArguments imported;
  report::ReportArguments report;
  std::vector<std::string> petsc_options;  ///< what stands after `--`
  linear::SolverOptions solver = {};       ///< what it says of the solvers
};

/// Meshes the scene, or reads a mesh file, says what the mesh is like, and writes it with its
/// groups as NAME.mesh.vtu and as a page to turn, NAME.mesh.html.
/// @throws chladni::Error after this, when an element cannot work, as told by the report on
/// quality,
///         or when the scene names a group that the mesh does not have.
void mesh_command(const ChladniArguments& arguments);

/// Frequency responses of the scene's [response], of the FE model, or of the reduced system or the
/// body in the output folder: NAME.response.h5, NAME.response.csv, NAME.response.html.
void response_command(const ChladniArguments& arguments);

/// Meshes, assembles and reduces; writes NAME.reduced.h5.
void reduce_command(const ChladniArguments& arguments);

/// Displacements and section forces of the scene under its supports and loads: NAME.static.vtu.
void static_command(const ChladniArguments& arguments);

/// Natural modes of the scene under its supports: NAME.modes.vtu.
void modes_command(const ChladniArguments& arguments);

/// Makes the modal body of NAME.reduced.h5; writes NAME.body.h5. Needs no PETSc.
void body_command(const ChladniArguments& arguments);

/// All of this, from the scene to both files.
void run_command(const ChladniArguments& arguments);

/// The sound of the limit cycle in NAME.squeal.h5 and what it does to the squeal: NAME.sound.h5,
/// NAME.sound.vtu, NAME.radiation.h5 and, if asked for, NAME.sound.wav. Needs no PETSc.
void sound_command(const ChladniArguments& arguments);

/// Checks a reduced system or a modal body.
/// @throws chladni::Error after the table is printed, when a check fails.
void check_command(const ChladniArguments& arguments);

/// Measured mode shapes beside the modes of a body: a table of MAC. Needs no PETSc.
void mac_command(const ChladniArguments& arguments);

/// Writes a reduced system or a body in the format of another program. Needs no PETSc.
void export_command(const ChladniArguments& arguments);

/// Writes a scene with the mesh, the sections, materials, couplings and supports of a deck.
/// @throws chladni::Error naming file, line and card of what is wrong or has no counterpart.
void import_command(const ChladniArguments& arguments);

/// The metres of a unit of length as scenes and options name it.
double metres_of(const std::string& length_unit);

/// The values of --format.
const std::vector<std::string>& export_formats();

/// The values of --sid-dialect.
const std::vector<std::string>& sid_dialects();
const std::vector<std::string>& fmi_versions();

/// The values of --sid-gyroscopic.
const std::vector<std::string>& sid_gyroscopic_orders();

/// Says what a file of Chladni holds.
void info_command(const ChladniArguments& arguments);

}  // namespace chladni::cli
