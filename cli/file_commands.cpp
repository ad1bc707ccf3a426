#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "cases/declared_scene.hpp"
#include "cases/ranks.hpp"
#include "cases/superelement.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/measured/measured_modes.hpp"
#include "report/describe_body.hpp"
#include "report/describe_responses.hpp"
#include "report/progress.hpp"
#include "report/text_table.hpp"
#include "scene/scene.hpp"

namespace chladni::cli {

using mbs_export::Check, mbs_export::Verdict;
using std::filesystem::path;

void info_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { fmt::print("{}", report::describe_file(arguments.info_file)); });
}

namespace {

std::vector<Check> checks_of(const std::string& path)
{
  const files::Reader file(path);
  const std::string format = file.text_attribute("/", "format");
  if (format == mbs_export::reduced_format) return check_reduced(mbs_export::read_reduced(file));
  if (format == mbs_export::body_format) return check_body(mbs_export::read_body(file));
  throw Error(fmt::format(
      "{}: a file of format '{}' has no checks; *.reduced.h5 and *.body.h5 have", path, format));
}

const char* name_of(Verdict verdict)
{
  if (verdict == Verdict::pass) return "pass";
  return verdict == Verdict::warn ? "warn" : "FAIL";
}

std::string number(double x)
{
  return std::isnan(x) ? "-" : fmt::format("{:.3g}", x);
}

report::TextTable table_of(const std::vector<Check>& checks)
{
  report::TextTable table{.header = {"check", "verdict", "value", "limit"}, .rows = {}};
  for (const Check& check : checks) {
    table.rows.push_back(
        {check.name, name_of(check.verdict), number(check.value), number(check.limit)});
  }
  return table;
}

void write_json(const std::string& file, const std::string& json, const std::vector<Check>& checks)
{
  std::vector<report::Json> list;
  for (const Check& check : checks) {
    list.push_back(report::Json::object({{"check", check.name},
                                         {"verdict", name_of(check.verdict)},
                                         {"value", check.value},
                                         {"limit", check.limit},
                                         {"meaning", check.meaning}}));
  }
  write_summary({.scene = file, .output = {}, .json = json},
                {{"file", file},
                 {"verdict", name_of(mbs_export::worst(checks))},
                 {"checks", report::Json::array(list)}},
                report::cost_so_far({}));
}

void print_checks(const std::string& file, const std::string& json)
{
  const std::vector<Check> checks = checks_of(file);
  write_json(file, json, checks);
  fmt::print("{}\n\n{}", file, report::format_table(table_of(checks)));
  int n_failed = 0;
  for (const Check& check : checks) {
    if (check.verdict == Verdict::pass) continue;
    fmt::print("\n{}: {}: {}", name_of(check.verdict), check.name, check.meaning);
    n_failed += check.verdict == Verdict::fail ? 1 : 0;
  }
  fmt::print("\n");
  if (n_failed > 0)
    throw Error(fmt::format("{}: {} of {} checks failed", file, n_failed, checks.size()));
}

}  // namespace

void check_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { print_checks(arguments.check_file, arguments.check_json); });
}

namespace {

void compare_modes(const MacArguments& arguments)
{
  const mbs_export::ModalBody body = mbs_export::read_body(arguments.body);
  std::optional<double> metres;
  if (!arguments.length_unit.empty()) metres = metres_of(arguments.length_unit);
  const mbs_export::MeasuredModes measured =
      mbs_export::read_measured_modes(arguments.measured, metres);
  for (const std::string& note : measured.notes) report::tell_note(report::printable(note));
  const mbs_export::ModalAssurance found =
      mbs_export::modal_assurance(body, measured, arguments.distance);
  fmt::print("{}\n\n{}\n{}", report::printable(body.title),
             report::format_table(report::list_assurance(measured, found)),
             report::format_table(report::describe(found)));
  write_summary({.scene = arguments.body, .output = {}, .json = arguments.json},
                report::assurance_json(found), report::cost_so_far({}));
}

}  // namespace

void mac_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { compare_modes(arguments.mac); });
}

namespace {

double newtons_of(const std::string& unit)
{
  if (unit == "mN") return 1e-3;
  if (unit == "kN") return 1e3;
  return unit == "lbf" ? mesh::pound_force : 1.0;
}

/// The stem of the deck in letters that a scene's name may have.
std::string name_of(const path& deck)
{
  std::string name = deck.stem().string();
  const auto is_allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
  };
  std::ranges::replace_if(
      name, [&](char c) { return !is_allowed(c); }, '_');
  return name;
}

mesh::DeckUnits units_of(const ImportArguments& arguments)
{
  const std::string usual = arguments.length_unit == "inch" ? "lbf" : "N";
  return {.length = metres_of(arguments.length_unit),
          .force = newtons_of(arguments.force_unit.empty() ? usual : arguments.force_unit)};
}

/// A scene, and beside it NAME.reduced.h5.
void import_superelement(const ImportArguments& arguments)
{
  if (arguments.output.empty()) {
    throw Error(
        fmt::format("{}: say where to write with --output scene.toml; the reduced system is "
                    "written beside it",
                    arguments.deck));
  }
  const cases::ImportedSystem imported =
      cases::imported_system(arguments.deck, units_of(arguments));
  const std::string name = name_of(arguments.deck);
  const std::string text = cases::imported_scene(imported, name);
  scene::parse_scene(text, arguments.output, scene::Purpose::everything);
  const path reduced = path(arguments.output).parent_path() / (name + ".reduced.h5");
  mbs_export::write_reduced(reduced, imported.system);
  files::write_text(arguments.output, text);
  for (const std::string& note : imported.notes) report::tell_note(report::printable(note));
  fmt::print("wrote {}\nwrote {}\n", reduced.string(), arguments.output);
}

void import_and_write(const ImportArguments& arguments)
{
  if (cases::is_superelement(arguments.deck)) return import_superelement(arguments);
  if (!mesh::is_deck(arguments.deck)) {
    throw Error(
        fmt::format("{}: only a deck of another program ({}) or a superelement of Nastran (.pch, "
                    ".dmig, .op4) is imported; other mesh files have no sections",
                    arguments.deck, mesh::extensions_with_programs(mesh::is_deck)));
  }
  const mesh::Declarations declared =
      mesh::declarations({.file = arguments.deck}, units_of(arguments));
  const path target = arguments.output.empty() ? path("scene.toml") : path(arguments.output);
  const path folder = std::filesystem::absolute(target).parent_path();
  const std::string text = cases::declared_scene(
      declared, {.name = name_of(arguments.deck),
                 .file = std::filesystem::proximate(arguments.deck, folder).generic_string(),
                 .length_unit = arguments.length_unit});
  const scene::Scene scene = scene::parse_scene(text, target.string(), scene::Purpose::fe_model);
  if (arguments.output.empty()) {
    fmt::print("{}", report::printable(text));
  } else {
    files::write_text(arguments.output, text);
    fmt::print("wrote {}\n", arguments.output);
  }
  for (const std::string& note : declared.notes)
    fmt::print(stderr, "note: {}\n", report::printable(note));
  for (const std::string& note : scene.notes)
    fmt::print(stderr, "note: {}\n", report::printable(note));
}

}  // namespace

double metres_of(const std::string& unit)
{
  if (unit == "mm") return 1e-3;
  if (unit == "cm") return 1e-2;
  return unit == "inch" ? 0.0254 : 1.0;
}

void import_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { import_and_write(arguments.imported); });
}

}  // namespace chladni::cli
