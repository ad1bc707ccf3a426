#include "plate/sections/section_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "plate/elements/beam_axes.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/sections/directors.hpp"
#include "plate/sections/profile.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

namespace {

enum class Kind { shell, beam };

Kind kind_of(const mesh::ElementBlock& block)
{
  return block.shape == mesh::Shape::line ? Kind::beam : Kind::shell;
}

int index_of_section(const SectionMap& map, const mesh::ElementBlock& block, int element)
{
  const int group = block.group[element];
  if (group < 0) return -1;
  return kind_of(block) == Kind::beam ? map.beam[group] : map.shell[group];
}

/// A formula may be negative where a table cannot.
void check_thickness(const mesh::Mesh& mesh, const ShellSection& section)
{
  if (section.thickness.formula.empty()) return;
  for (const int node : mesh::find_group(mesh, section.group).nodes) {
    const double t = value_at(section.thickness, mesh.positions[node]);
    if (t > 0.0) continue;
    throw Error(fmt::format(
        "section of group \"{}\": the thickness \"{}\" is {:.6g} m at node {}; it must be > 0",
        section.group, section.thickness.formula, t, mesh.node_numbers[node]));
  }
}

/// An entry that is not a number would be found in a factor or a spectrum of all elements, if at
/// all.
void refuse_not_finite(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const ElementMatrices& matrices)
{
  const bool is_K = matrices.K.allFinite(), is_M = matrices.M.allFinite();
  if (is_K && is_M) return;
  const std::string group = mesh.groups[std::size_t(block.group[element])].name;
  const char* which = is_K ? "mass" : is_M ? "stiffness" : "stiffness and mass";
  const char* why =
      kind_of(block) == Kind::beam
          ? "look at its length, section and material"
          : "the two faces of the shell cross in it, because it is curved more sharply than half "
            "its "
            "thickness, or its values overflow; make the section thinner, round the corner more "
            "widely, or model it by a fold between flat parts";
  throw Error(fmt::format("element {} of group \"{}\": its {} is not a number: {}",
                          block.numbers[element], group, which, why));
}

template <class Section>
double loss_factor_of(const Section& section)
{
  return section.loss_factor.value_or(section.material.loss_factor);
}

}  // namespace

std::vector<char> nodes_on_surfaces(const mesh::Mesh& mesh)
{
  std::vector<char> on_surface(mesh.positions.size(), 0);
  for (const mesh::ElementBlock& block : mesh.blocks)
    if (block.shape != mesh::Shape::line)
      for (const int node : block.nodes) on_surface[static_cast<std::size_t>(node)] = 1;
  return on_surface;
}

LineFields line_fields(const std::vector<char>& on_surface, std::span<const int> nodes)
{
  const auto is_on_surface = [&](int node) {
    return on_surface[static_cast<std::size_t>(node)] != 0;
  };
  const bool is_rib =
      nodes.size() > 2 && std::ranges::any_of(nodes.subspan(1, nodes.size() - 2), is_on_surface);
  return is_rib ? LineFields::isoparametric : LineFields::best;
}

SectionMap map_sections(const mesh::Mesh& mesh, const Structure& structure)
{
  const SectionMap map{.shell = section_of_group(mesh, structure.shells),
                       .beam = section_of_group(mesh, structure.beams),
                       .on_surface = nodes_on_surfaces(mesh)};
  for (const ShellSection& section : structure.shells) check_thickness(mesh, section);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (kind_of(block) == Kind::shell) check_element_exists(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) {
      const int section = index_of_section(map, block, e);
      if (section < 0) {
        throw Error(
            fmt::format("element {} has no section: name its physical group in a [[section]]",
                        block.numbers[e]));
      }
      if (kind_of(block) == Kind::beam)
        node_axes(element_positions(mesh, block, e), structure.beams[section]);
    }
  }
  return map;
}

PlacedMatrices element_matrices(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                int element, const ElementContext& context)
{
  const int index = index_of_section(context.sections, block, element);
  const NodeVectors x = element_positions(mesh, block, element);
  if (kind_of(block) == Kind::beam) {
    const LineFields fields =
        line_fields(context.sections.on_surface, block.element_nodes(element));
    PlacedMatrices line{.matrices = beam_matrices(x, context.structure.beams[index], fields),
                        .arms = {}};
    refuse_not_finite(mesh, block, element, line.matrices);
    return line;
  }
  const ShellSection& section = context.structure.shells[index];
  const ShellNodes shell = shell_nodes(mesh, block, element, context.directors, section);
  PlacedMatrices placed{
      .matrices = shell_matrices(block.shape, block.order, shell, section.material), .arms = {}};
  refuse_not_finite(mesh, block, element, placed.matrices);
  if (section.offset != Profile(0.0)) placed.arms = shell.x - x;
  return placed;
}

double loss_factor(const mesh::ElementBlock& block, int element, const ElementContext& context)
{
  const int index = index_of_section(context.sections, block, element);
  return kind_of(block) == Kind::beam ? loss_factor_of(context.structure.beams[index])
                                      : loss_factor_of(context.structure.shells[index]);
}

bool has_loss_factors(const Structure& structure)
{
  const auto is_lossy = [](const auto& section) { return loss_factor_of(section) > 0.0; };
  return std::ranges::any_of(structure.shells, is_lossy) ||
         std::ranges::any_of(structure.beams, is_lossy) ||
         std::ranges::any_of(structure.springs,
                             [](const Spring& spring) { return spring.loss_factor > 0.0; });
}

}  // namespace chladni::plate
