#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/holders.hpp"
#include "mesh/vectors.hpp"

namespace chladni::mesh {
namespace {

using std::numbers::pi;

/// Area, second moments and torsion constant of a profile; x along n1, y along n2.
struct ProfileMoments {
  double area, of_x_squared, of_y_squared, J;
  double shear_factor;  ///< as Abaqus has it for this kind of profile
};

ProfileMoments rectangle(double a, double b)
{
  const double l = std::max(a, b), s = std::min(a, b), ratio = s / l;
  const double J = l * s * s * s * (1.0 / 3.0 - 0.21 * ratio * (1.0 - std::pow(ratio, 4) / 12.0));
  return {a * b, b * a * a * a / 12.0, a * b * b * b / 12.0, J, 0.85};
}

ProfileMoments pipe(double outer, double inner, double shear_factor)
{
  const double I = pi / 4.0 * (std::pow(outer, 4) - std::pow(inner, 4));
  return {pi * (outer * outer - inner * inner), I, I, 2.0 * I, shear_factor};
}

ProfileMoments moments(const Keyword& section, const KeywordRow& row)
{
  const std::string& kind = section.parameter("SECTION");
  const double first = section.real(row, 0, "a length of the profile");
  if (kind == "CIRC") return pipe(first, 0.0, 0.89);
  if (kind != "RECT" && kind != "PIPE")
    section.refuse(fmt::format("the profile {} is not known; RECT, CIRC and PIPE are", kind));
  const double second = section.real(row, 1, "a length of the profile");
  if (kind == "RECT") return rectangle(first, second);
  if (!(second < first)) section.refuse(row, "the wall of the pipe is thicker than its radius");
  return pipe(first, first - second, 0.53);
}

/// The one data line of a keyword.
const KeywordRow& only_row(const Keyword& keyword)
{
  if (keyword.rows.size() != 1)
    keyword.refuse(fmt::format("needs one data line, has {}", keyword.rows.size()));
  return keyword.rows.front();
}

/// Components of a boundary condition by its name, from 0.
std::optional<std::vector<int>> components_named(std::string_view name)
{
  if (name == "ENCASTRE") return std::vector<int>{0, 1, 2, 3, 4, 5};
  if (name == "PINNED") return std::vector<int>{0, 1, 2};
  if (name == "XSYMM") return std::vector<int>{0, 4, 5};
  if (name == "YSYMM") return std::vector<int>{1, 3, 5};
  if (name == "ZSYMM") return std::vector<int>{2, 3, 4};
  return std::nullopt;
}

class Declarer {
 public:
  Declarer(std::span<const Keyword> keywords, const Deck& deck, const DeckUnits& units)
      : model_(abaqus_model(keywords)), sets_(abaqus_sets(keywords)), units_(units), holders_(deck)
  {}

  Declarations declare(const Deck& deck)
  {
    for (std::size_t i = 0; i < model_.size(); ++i) {
      const Keyword& keyword = model_[i];
      if (keyword.name == "MATERIAL") material(i);
      if (keyword.name == "SHELL SECTION") shell(keyword);
      if (keyword.name == "BEAM SECTION") beam(keyword);
    }
    check_densities();
    declare_couplings(deck, units_, holders_, all_);
    for (const Keyword& keyword : model_)
      if (keyword.name == "BOUNDARY") boundary(keyword);
    for (std::size_t g = 0; g < deck.groups.size(); ++g) {
      const DeckGroup& group = deck.groups[g];
      const bool is_there =
          std::ranges::find(all_.shells, group.name, &DeclaredShell::group) != all_.shells.end() ||
          std::ranges::find(all_.beams, group.name, &DeclaredBeam::group) != all_.beams.end();
      if (group.dimension == 0 || is_there) continue;
      const auto element = std::ranges::find(deck.elements, int(g), &DeckElement::group);
      throw Error(fmt::format("{}: *ELEMENT: element {} is of \"{}\", which no section names",
                              element->place, element->number, group.name));
    }
    return std::move(all_);
  }

 private:
  /// What `make` returns; its errors get line and keyword.
  static auto told(const Keyword& keyword, const std::string& place, auto&& make)
  {
    try {
      return make();
    } catch (const Error& error) {
      keyword.refuse({place, {}}, error.what());
    }
  }

  void material(std::size_t at)
  {
    const Keyword& keyword = model_[at];
    DeclaredMaterial material{
        .name = keyword.parameter("NAME"), .young = 0.0, .poisson = 0.0, .density = 0.0};
    bool is_elastic = false;
    for (++at; at < model_.size(); ++at) {
      const Keyword& part = model_[at];
      if (part.name == "ELASTIC") {
        part.expect_only({"TYPE"});
        if (part.has("TYPE") && part.parameter("TYPE").substr(0, 3) != "ISO")
          part.refuse("only TYPE = ISOTROPIC is known");
        material.young = part.real(only_row(part), 0, "Young's modulus") * units_.stress();
        material.poisson = part.real_or(only_row(part), 1, "Poisson's ratio", 0.0);
        is_elastic = true;
      } else if (part.name == "DENSITY") {
        part.expect_only({});
        material.density = part.real(only_row(part), 0, "the density") * units_.density();
      } else {
        break;
      }
    }
    if (!is_elastic) keyword.refuse(fmt::format("{} has no *ELASTIC", material.name));
    all_.materials.push_back(material);
    keyword_of_[material.name] = &keyword;
  }

  /// Materials without a density are no error as long as no element is of them.
  void check_densities()
  {
    std::erase_if(all_.materials, [&](const DeclaredMaterial& material) {
      if (material.density > 0.0) return false;
      const auto is_of_it = [&](const auto& section) { return section.material == material.name; };
      if (std::ranges::any_of(all_.shells, is_of_it) || std::ranges::any_of(all_.beams, is_of_it)) {
        keyword_of_.at(material.name)
            ->refuse(fmt::format("{} has no *DENSITY, without which there are no natural "
                                 "frequencies; give it one, "
                                 "a small one to what is to have no mass",
                                 material.name));
      }
      return true;
    });
  }

  void shell(const Keyword& keyword)
  {
    keyword.expect_only({"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "SECTION INTEGRATION"});
    const double thickness = keyword.real(only_row(keyword), 0, "the thickness") * units_.length;
    // Abaqus tells where the nodes are, a scene where the middle is.
    double of_thickness = 0.0;
    if (keyword.has("OFFSET")) {
      const std::string& offset = keyword.parameter("OFFSET");
      of_thickness = offset == "SPOS"   ? 0.5
                     : offset == "SNEG" ? -0.5
                                        : keyword.real({keyword.place, {offset}}, 0, "OFFSET");
    }
    all_.shells.push_back({.group = keyword.parameter("ELSET"),
                           .material = keyword.parameter("MATERIAL"),
                           .thickness = thickness,
                           .offset = of_thickness == 0.0 ? 0.0 : -of_thickness * thickness});
  }

  void beam(const Keyword& keyword)
  {
    keyword.expect_only({"ELSET", "MATERIAL", "SECTION"});
    if (keyword.rows.empty() || keyword.rows.size() > 2)
      keyword.refuse("needs the profile, and its direction n1 on a line of its own");
    const ProfileMoments profile = moments(keyword, keyword.rows.front());
    Vector n1{0.0, 0.0, -1.0};
    if (keyword.rows.size() == 2)
      for (std::size_t c = 0; c < 3; ++c) n1[c] = keyword.real_or(keyword.rows[1], c, "n1", 0.0);
    if (!(norm(n1) > 0.0)) keyword.refuse("its direction n1 is zero");
    all_.beams.push_back({.group = keyword.parameter("ELSET"),
                          .material = keyword.parameter("MATERIAL"),
                          .area = profile.area * units_.area(),
                          .I_y = profile.of_x_squared * units_.second_moment(),
                          .I_z = profile.of_y_squared * units_.second_moment(),
                          .J = profile.J * units_.second_moment(),
                          .shear_factor_y = profile.shear_factor,
                          .shear_factor_z = profile.shear_factor,
                          .orientation = unit(n1)});
  }

  static std::vector<int> components(const Keyword& keyword, const KeywordRow& row)
  {
    if (const auto named = components_named(Keyword::field(row, 1))) return *named;
    const std::int64_t first = keyword.integer(row, 1, "component");
    const bool is_one = Keyword::field(row, 2).empty();
    const std::int64_t last = is_one ? first : keyword.integer(row, 2, "component");
    if (first > last || last > 6)
      keyword.refuse(row, fmt::format("{} to {} are no components of 1 to 6", first, last));
    if (keyword.real_or(row, 3, "a displacement", 0.0) != 0.0)
      keyword.refuse(row, "prescribes a displacement; a scene's support holds at zero only");
    std::vector<int> held;
    for (std::int64_t c = first; c <= last; ++c) held.push_back(static_cast<int>(c) - 1);
    return held;
  }

  void boundary(const Keyword& keyword)
  {
    keyword.expect_only({});
    for (const KeywordRow& row : keyword.rows) {
      const std::string& name = row.fields.front();
      const std::string group =
          keyword.is_integer(name) ? "boundary_" + name : name_of_node_set(name, sets_);
      const std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, name, sets_);
      const std::vector<int> held = components(keyword, row);
      const std::vector<std::int64_t> supported =
          supported_nodes(holders_, row.place + ": *BOUNDARY", nodes, all_);
      for (const std::string& holder :
           told(keyword, row.place, [&] { return holders_.of(group, supported); }))
        add_support(all_, holder, held);
    }
  }

  std::span<const Keyword> model_;
  AbaqusSets sets_;
  DeckUnits units_;
  Holders holders_;
  std::map<std::string, const Keyword*> keyword_of_;  ///< by the name of the material
  Declarations all_;
};

}  // namespace

Declarations abaqus_declarations(std::span<const Keyword> keywords, const Deck& deck,
                                 const DeckUnits& units)
{
  return Declarer(keywords, deck, units).declare(deck);
}

}  // namespace chladni::mesh
