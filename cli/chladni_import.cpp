#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "cases/declared_scene.hpp"
#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "common/error.hpp"
#include "files/text_file.hpp"
#include "report/output.hpp"
#include "scene/scene.hpp"

namespace chladni::cli {
namespace {

using std::filesystem::path;

double newtons_of(const std::string& unit)
{
  if (unit == "mN") return 1e-3;
  if (unit == "kN") return 1e3;
  return unit == "lbf" ? 4.4482216152605 : 1.0;
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

void import_and_write(const ImportArguments& arguments)
{
  if (!mesh::is_deck(arguments.deck)) {
    throw Error(
        fmt::format("{}: only a deck of Nastran (.bdf, .nas, .dat) or Abaqus (.inp) is "
                    "imported; other mesh files have no sections",
                    arguments.deck));
  }
  const std::string usual = arguments.length_unit == "inch" ? "lbf" : "N";
  const mesh::Declarations declared = mesh::declarations(
      {.file = arguments.deck},
      {.length = metres_of(arguments.length_unit),
       .force = newtons_of(arguments.force_unit.empty() ? usual : arguments.force_unit)});
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
