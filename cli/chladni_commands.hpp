#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/seal.hpp"
#include "cli/self_description.hpp"
#include "linear/solver_options.hpp"
#include "report/page/pages.hpp"

namespace CLI {

class App;

}  // namespace CLI

/// The subcommands of the program `chladni`. Each writes its files at its end and prints its
/// summary on the first rank. Each throws chladni::Error when it fails, before it writes a file.
/// @note Collective on all ranks.
namespace chladni::cli {

/// Arguments of `chladni export`.
struct ExportArguments {
  std::string source;      ///< a scene or a *.reduced.h5
  std::string format;      ///< one of export_formats()
  std::string from = ".";  ///< folder with the scene's reduced system
  std::string output;      ///< output file; empty for NAME and the extension of the format
  int superelement = 100;  ///< superelement number in Nastran
  std::string sid_dialect = "simpack";     ///< one of sid_dialects()
  std::string sid_gyroscopic = "by-mode";  ///< one of sid_gyroscopic_orders()
  std::string fmi = "2";                   ///< FMI version, one of fmi_versions()
  std::vector<std::string> nodes;          ///< sets of attachment nodes for the FMU; empty: all
  std::string json;                        ///< file for the JSON summary; empty for none
  bool stale = false;  ///< accept a reduced file that was made before the scene changed
};

/// Arguments of `chladni import`.
struct ImportArguments {
  std::string deck;         ///< deck of Nastran or Abaqus
  std::string length_unit;  ///< its unit of length, such as "mm"
  /// Its unit of force, such as "N"; empty: N, or lbf for lengths in inches.
  std::string force_unit;
  std::string output;  ///< output file of the scene; empty for stdout
};

/// Further arguments of `chladni mesh`, whose SCENE may be a mesh file.
struct QualityChoice {
  bool quality = false;  ///< report the element quality
  /// Unit of length of a mesh file without a scene; empty if the file states its own.
  std::string length_unit;
};

/// Further arguments of `chladni sound`.
struct SoundChoice {
  bool radiation_only = false;  ///< only the radiation damping of the modes, without a limit cycle
};

/// Further arguments of `chladni response`.
struct ResponseChoice {
  std::string universal_file;  ///< universal file to write; empty for none
  std::string measured;        ///< universal file of measured responses; empty for none
  double distance = 0.0;       ///< largest distance from a measured node to its place, m; 0: none
  std::string length_unit;     ///< unit of length if the measurement does not state one
};

/// Further arguments of `chladni compare`.
struct CompareChoice {
  int n_frequencies = 20;                          ///< of the supported body, compared
  std::vector<int> modes = {10, 20, 40, 80, 160};  ///< numbers of modes that are tried
};

/// Arguments of `chladni mac`.
struct MacArguments {
  std::string body;         ///< *.body.h5
  std::string measured;     ///< universal file with the measured modes
  double distance = 0.0;    ///< largest distance from a measured node to its node of the body, m
  std::string length_unit;  ///< unit of length if the measurement does not state one
  std::string json;         ///< file for the JSON summary; empty for none
};

/// Arguments of all subcommands of `chladni`.
struct ChladniArguments {
  SceneArguments scene;
  bool trusts_mesh = false;  ///< the mesh file is the user's own and may run programs
  std::string mesh_cache;    ///< folder in which meshes are kept; empty for none
  QualityChoice mesh;
  SoundChoice sound;
  ResponseChoice response;
  CompareChoice compare;
  MacArguments mac;
  std::string info_file;
  std::string check_file;
  std::string check_json;  ///< file for the JSON summary; empty for none
  SealArguments seal;
  SelfDescription self;
  ExportArguments exported;
  ImportArguments imported;
  report::ReportArguments report;
  std::vector<std::string> petsc_options;  ///< PETSc options, the words after `--`
  linear::SolverOptions solver = {};       ///< solver options found among the PETSc options
};

/// Meshes the scene or reads a mesh file, prints a summary of the mesh, and writes it with its
/// groups: NAME.mesh.vtu, and NAME.mesh.html, a page in which the mesh can be turned.
/// @throws chladni::Error after the files are written, when an element is unusable (with the report
///         on quality) or when the scene names a group that the mesh does not have.
void mesh_command(const ChladniArguments& arguments);

/// Computes the frequency responses of the scene's [response] with the FE model, or with the
/// reduced system or body in the output folder; writes NAME.response.h5, NAME.response.csv and
/// NAME.response.html.
void response_command(const ChladniArguments& arguments);

/// Meshes, assembles and reduces the scene; writes NAME.reduced.h5.
void reduce_command(const ChladniArguments& arguments);

/// Computes displacements and section forces under the scene's supports and loads; writes
/// NAME.static.vtu.
void static_command(const ChladniArguments& arguments);

/// Computes natural modes under the scene's supports; writes NAME.modes.vtu.
void modes_command(const ChladniArguments& arguments);

/// Makes the modal body of NAME.reduced.h5; writes NAME.body.h5. Needs no PETSc.
void body_command(const ChladniArguments& arguments);

/// Performs `reduce` and `body`; writes both files.
void run_command(const ChladniArguments& arguments);

/// Reduces the scene by every method with several numbers of modes and compares the frequencies
/// with those of the FE model: error against time and size; writes NAME.compare.svg.
void compare_command(const ChladniArguments& arguments);

/// Computes the sound of the limit cycle in NAME.squeal.h5 and the effect of radiation damping on
/// the squeal: NAME.sound.h5, NAME.sound.vtu, NAME.radiation.h5 and, if asked for, NAME.sound.wav.
/// Needs no PETSc.
void sound_command(const ChladniArguments& arguments);

/// Checks a reduced system or a modal body.
/// @throws chladni::Error after the table is printed, when a check fails.
void check_command(const ChladniArguments& arguments);

/// Compares measured mode shapes with the modes of a body by a table of MAC values. Needs no PETSc.
void mac_command(const ChladniArguments& arguments);

/// Writes a reduced system or a body in the format of another program. Needs no PETSc.
void export_command(const ChladniArguments& arguments);

/// Writes a scene with the mesh, sections, materials, couplings and supports of a deck.
/// @throws chladni::Error naming file, line and card, when a card is wrong or has no counterpart.
void import_command(const ChladniArguments& arguments);

/// Length of a unit in metres, for the unit names of scenes and options.
double metres_of(const std::string& length_unit);

/// The values of --format.
const std::vector<std::string>& export_formats();

/// The values of --sid-dialect.
const std::vector<std::string>& sid_dialects();
/// The values of --fmi.
const std::vector<std::string>& fmi_versions();

/// The values of --sid-gyroscopic.
const std::vector<std::string>& sid_gyroscopic_orders();

/// Prints what a file of Chladni contains.
void info_command(const ChladniArguments& arguments);

/// The option --length-unit of a command that reads a file without a unit of its own.
void declare_length_unit(CLI::App& app, std::string& unit);

/// The subcommand `mac`.
void declare_mac(CLI::App& app, MacArguments& arguments);

/// The options of `compare` besides those of all commands on scenes.
void declare_compare(CLI::App& compare, CompareChoice& choice);

/// The options of `response` besides those of all commands on scenes.
void declare_response(CLI::App& response, ResponseChoice& choice);

}  // namespace chladni::cli
