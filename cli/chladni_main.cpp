#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iterator>
#include <thread>

#include "cases/ranks.hpp"
#include "cli/arguments.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/petsc_session.hpp"
#include "cli/seal.hpp"
#include "cli/self_description.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/output_file.hpp"
#include "linear/blas_kernels.hpp"
#include "linear/blas_memory.hpp"
#include "linear/solver_options.hpp"
#include "mesh/mesh_options.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "report/version.hpp"
#include "scene/keys.hpp"

namespace {

namespace cli = chladni::cli;

struct Subcommand {
  const char* name;
  const char* what;
  const char* examples;
  void (*perform)(const chladni::cli::ChladniArguments&);
};

constexpr Subcommand on_scenes[] = {
    {"mesh",
     "meshes the scene, prints a summary of the mesh and draws it: NAME.mesh.vtu, NAME.mesh.html",
     "Examples:\n  chladni mesh scene.toml\n  chladni mesh disc.msh --quality --json mesh.json",
     chladni::cli::mesh_command},
    {"static", "displacements and section forces under supports and loads: NAME.static.vtu",
     "Examples:\n  chladni static scene.toml --output out\n"
     "  mpirun -n 2 chladni static scene.toml --json static.json",
     chladni::cli::static_command},
    {"modes", "natural modes under supports: NAME.modes.vtu",
     "Examples:\n  chladni modes scene.toml --output out\n"
     "  mpirun -n 2 chladni modes scene.toml --json modes.json",
     chladni::cli::modes_command},
    {"reduce", "meshes, assembles and reduces: NAME.reduced.h5",
     "Examples:\n  chladni reduce scene.toml --output out\n"
     "  mpirun -n 2 chladni reduce scene.toml -- -log_view",
     chladni::cli::reduce_command},
    {"compare",
     "tries the methods of reduction on the scene: error against time and size: NAME.compare.svg",
     "Example:\n  chladni compare scene.toml --modes 20,50,100 --frequencies 30 --output out",
     chladni::cli::compare_command},
    {"body", "makes the modal body of NAME.reduced.h5: NAME.body.h5",
     "Example (after a change of [body] in the scene):\n  chladni body scene.toml --output out",
     chladni::cli::body_command},
    {"response",
     "frequency responses of the body, the reduced system or the FE model: NAME.response.h5, .csv, "
     ".html",
     "Examples:\n  chladni response scene.toml --output out --json out/response.json\n"
     "  mpirun -n 2 chladni response scene.toml --output out    ([response] of = \"fe\")\n"
     "  chladni response scene.toml --output out --measured hammer.uff --distance 0.005",
     chladni::cli::response_command},
    {"sound", "the sound of the limit cycle that `squeal run` found: NAME.sound.h5, .vtu, .wav",
     "Examples:\n  chladni sound scene.toml --output out --json out/sound.json\n"
     "  chladni sound scene.toml --radiation --output out    (before `squeal run`)",
     chladni::cli::sound_command},
    {"run", "meshes, reduces and makes the body: NAME.reduced.h5, NAME.body.h5",
     "Examples:\n  chladni run scene.toml --output out --json out/chladni.json\n"
     "  mpirun -n 2 chladni run scene.toml",
     chladni::cli::run_command},
};

void declare_export(CLI::App& app, chladni::cli::ExportArguments& arguments)
{
  CLI::App* exported = app.add_subcommand("export", "writes files for other programs");
  exported
      ->add_option("SOURCE", arguments.source,
                   "the scene file, or a *.reduced.h5 (for the format fmu: a *.body.h5)")
      ->required();
  exported->add_option("--format", arguments.format, "file format to write")
      ->required()
      ->check(CLI::IsMember(chladni::cli::export_formats()));
  chladni::cli::declare_stale(*exported, arguments.stale);
  exported->add_option("--from", arguments.from, "folder of the scene's NAME.reduced.h5")
      ->type_name("DIR")
      ->capture_default_str();
  exported->add_option("--output", arguments.output, "file to write")->type_name("FILE");
  exported->add_option("--superelement", arguments.superelement, "superelement number in Nastran")
      ->check(CLI::Range(1, 9999))
      ->capture_default_str();
  exported
      ->add_option("--sid-dialect", arguments.sid_dialect,
                   "program whose order of indices the SID_FEM file uses")
      ->check(CLI::IsMember(chladni::cli::sid_dialects()))
      ->capture_default_str();
  exported
      ->add_option("--sid-gyroscopic", arguments.sid_gyroscopic,
                   "order of the columns of Gr and Ge in the SID_FEM file")
      ->check(CLI::IsMember(chladni::cli::sid_gyroscopic_orders()))
      ->capture_default_str();
  exported->add_option("--fmi", arguments.fmi, "FMI version of the FMU")
      ->check(CLI::IsMember(chladni::cli::fmi_versions()))
      ->capture_default_str();
  exported
      ->add_option("--nodes", arguments.nodes,
                   "sets of attachment nodes with forces and motions in the FMU; default: all")
      ->type_name("SET")
      ->delimiter(',');
  exported->add_option("--json", arguments.json, "writes the summary as JSON")->type_name("FILE");
  exported->footer(
      "Examples:\n  chladni export out/disc.reduced.h5 --format nastran-op4 --output disc.op4\n"
      "  chladni export scene.toml --from out --format mbdyn-develop --output disc.fem\n"
      "  chladni export scene.toml --from out --format sid --sid-dialect welib\n"
      "  chladni export scene.toml --from out --format exudyn --output disc.exudyn.hdf5\n"
      "  chladni export out/disc.body.h5 --format fmu --fmi 3 --nodes track,hub\n"
      "  chladni export scene.toml --from out --format fmu-brake --output brake.fmu");
}

void declare_import(CLI::App& app, chladni::cli::ImportArguments& arguments)
{
  CLI::App* imported = app.add_subcommand(
      "import",
      "writes a scene with the mesh and model of a deck of another program, or of a superelement");
  const std::string decks = chladni::mesh::extensions_with_programs(chladni::mesh::is_deck);
  imported
      ->add_option("DECK", arguments.deck, decks + "; superelements of Nastran: .pch, .dmig, .op4")
      ->required();
  chladni::cli::declare_length_unit(*imported, arguments.length_unit);
  imported->get_option("--length-unit")->required();
  imported
      ->add_option("--force-unit", arguments.force_unit,
                   "unit of force of the deck; default: N, or lbf when lengths are in inches")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"N", "mN", "kN", "lbf"}));
  imported->add_option("--output", arguments.output, "scene file to write; default: print it")
      ->type_name("FILE");
  imported->footer(
      "Examples:\n  chladni import disc.bdf --length-unit mm --output scene.toml\n"
      "  chladni import pad.pch --length-unit mm --output out/pad.toml    (and "
      "out/pad.reduced.h5)");
}

/// What tells of files of Chladni.
void declare_readers(CLI::App& app, chladni::cli::ChladniArguments& arguments)
{
  CLI::App* info = app.add_subcommand("info", "prints what a file of Chladni contains");
  info->add_option("FILE", arguments.info_file,
                   "*.reduced.h5, *.body.h5, *.response.h5 or *.squeal.h5")
      ->required();
  info->footer("Example:\n  chladni info out/disc.body.h5");
  CLI::App* check = app.add_subcommand("check", "checks a reduced system or a modal body");
  check->add_option("FILE", arguments.check_file, "*.reduced.h5 or *.body.h5")->required();
  check->add_option("--json", arguments.check_json, "writes the table as JSON")->type_name("FILE");
  check->footer("Example (exit code 1 when a check fails):\n  chladni check out/disc.reduced.h5");
}

void declare_subcommands(CLI::App& app, chladni::cli::ChladniArguments& arguments)
{
  for (const Subcommand& subcommand : on_scenes) {
    CLI::App* declared = app.add_subcommand(subcommand.name, subcommand.what);
    chladni::cli::declare_scene_arguments(*declared, arguments.scene);
    declared->footer(subcommand.examples);
  }
  for (const char* meshes : {"mesh", "static", "modes", "response", "reduce", "run", "compare"}) {
    app.get_subcommand(meshes)->add_flag(
        "--trust-mesh", arguments.trusts_mesh,
        "the mesh file is your own: a .geo may run programs and write files, without a time limit");
    app.get_subcommand(meshes)
        ->add_option("--mesh-cache", arguments.mesh_cache,
                     "keeps meshes in this folder, for runs with the same mesh options and files")
        ->type_name("FOLDER");
  }
  app.get_subcommand("mesh")->add_flag(
      "--quality", arguments.mesh.quality,
      "reports element quality and unusable elements; SCENE may be a .msh, .geo, .step, .unv, "
      ".med or a deck");
  chladni::cli::declare_length_unit(*app.get_subcommand("mesh"), arguments.mesh.length_unit);
  chladni::cli::declare_response(*app.get_subcommand("response"), arguments.response);
  chladni::cli::declare_compare(*app.get_subcommand("compare"), arguments.compare);
  for (const char* reader : {"body", "response", "sound"})
    chladni::cli::declare_stale(*app.get_subcommand(reader), arguments.scene.stale);
  app.get_subcommand("sound")->add_flag("--radiation", arguments.sound.radiation_only,
                                        "computes only the radiation damping of the modes: "
                                        "NAME.radiation.h5, for `radiation = true`");
  declare_readers(app, arguments);
  declare_export(app, arguments.exported);
  declare_import(app, arguments.imported);
  chladni::cli::declare_mac(app, arguments.mac);
  chladni::report::declare_report(app, arguments.report);
  chladni::cli::declare_seal(app, arguments.seal);
  chladni::cli::declare_self_description(app, arguments.self);
  app.add_subcommand("scene-reference", "prints every key of a scene file, in Markdown")
      ->footer("Example:\n  chladni scene-reference > scene_reference.md");
  app.require_subcommand(1);
}

void perform(const CLI::App& app, const chladni::cli::ChladniArguments& arguments)
{
  for (const Subcommand& subcommand : on_scenes)
    if (app.got_subcommand(subcommand.name)) return subcommand.perform(arguments);
  if (app.got_subcommand("import")) return chladni::cli::import_command(arguments);
  if (app.got_subcommand("mac")) return chladni::cli::mac_command(arguments);
  if (app.got_subcommand("export")) return chladni::cli::export_command(arguments);
  if (app.got_subcommand("report"))
    return chladni::cases::on_first_rank([&] { chladni::report::write_report(arguments.report); });
  if (app.got_subcommand("seal"))
    return chladni::cases::on_first_rank([&] { chladni::cli::seal(arguments.seal); });
  if (app.got_subcommand("scene-reference")) {
    return chladni::cases::on_first_rank(
        [] { fmt::print("{}", chladni::scene::scene_reference()); });
  }
  if (app.got_subcommand("check")) return chladni::cli::check_command(arguments);
  chladni::cli::info_command(arguments);
}

/// Prints the failure once, and ends the other ranks with this one.
int report_failure(const std::exception& error)
{
  // A failure is the same on all ranks as a rule; time for the first one to say it.
  if (chladni::cases::rank() != 0) std::this_thread::sleep_for(std::chrono::seconds(2));
  fmt::print(stderr, "{}\n", chladni::report::said(error));
  std::fflush(nullptr);
  if (chladni::cases::n_ranks() > 1) chladni::cli::abort_all_ranks(chladni::cli::exit_failed);
  return chladni::cli::exit_failed;
}

int perform_with_petsc(const CLI::App& app, chladni::cli::ChladniArguments arguments)
{
  const chladni::cli::PetscSession session(arguments.petsc_options);
  chladni::files::leave_nothing_to_exit();
  chladni::files::remove_unfinished_files_on_signals();
  try {
    arguments.solver = chladni::linear::read_solver_options(PETSC_COMM_WORLD);
    perform(app, arguments);
    chladni::cli::tell_of_unused_options(arguments.petsc_options);
    chladni::report::finish_printing();
    return chladni::cli::exit_ok;
  } catch (const std::exception& error) {
    return report_failure(error);
  }
}

void end_where_addresses_lack()
{
  const std::string lacking = chladni::linear::lacking_addresses();
  if (lacking.empty()) return;
  fmt::print(stderr, "{}\n", lacking);
  std::fflush(nullptr);
  _exit(cli::exit_failed);
}

}  // namespace

int main(int argc, char** argv)
{
  chladni::linear::take_fitting_blas_kernels(argv);
  end_where_addresses_lack();
  char** const end = argv + argc;
  char** const dashes = std::find(argv + 1, end, std::string_view("--"));
  chladni::cli::ChladniArguments arguments;
  if (dashes != end) arguments.petsc_options.assign(dashes + 1, end);

  CLI::App app("From a mesh of shells to a modal body.", "chladni");
  app.set_version_flag("--version", fmt::format("chladni {}", chladni::report::version));
  declare_subcommands(app, arguments);
  app.footer(
      "PETSc options follow after --.\n"
      "Examples:\n"
      "  chladni run scene.toml --output out\n"
      "  mpirun -n 2 chladni reduce scene.toml -- -log_view\n"
      "  chladni info out/disc.body.h5\n"
      "  chladni report scene.toml --output out");
  if (const auto code = chladni::cli::parse_arguments(app, {argv + 1, dashes})) return *code;
  if (arguments.scene.quiet) chladni::report::be_quiet();
  try {
    if (chladni::cli::describe_itself(app, arguments.self)) {
      chladni::report::finish_printing();
      return chladni::cli::exit_ok;
    }
    return perform_with_petsc(app, arguments);
  } catch (const std::exception& error) {  // PETSc did not start
    fmt::print(stderr, "{}\n", chladni::report::said(error));
    return chladni::cli::exit_failed;
  }
}
