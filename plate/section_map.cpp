#include "plate/section_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>

#include "common/error.hpp"
#include "plate/beam_element.hpp"
#include "plate/directors.hpp"
#include "plate/shell_element.hpp"

namespace chladni::plate {

namespace {

enum class Kind { shell, beam };

Kind kind_of(const mesh::ElementBlock& block)
{
  return block.shape == mesh::Shape::line ? Kind::beam : Kind::shell;
}

/// Index into `sections` of each group of the mesh, -1 where there is none.
template <typename Section>
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const Section> sections,
                                  Kind kind)
{
  std::vector<int> section(mesh.groups.size(), -1);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const mesh::Group& group = mesh::find_group(mesh, sections[s].group);
    const auto index = static_cast<std::size_t>(&group - mesh.groups.data());
    const auto in_group = [&](const mesh::ElementBlock& block) {
      return kind_of(block) == kind && std::ranges::count(block.group, static_cast<int>(index)) > 0;
    };
    if (std::ranges::none_of(mesh.blocks, in_group)) {
      throw Error(fmt::format("section of group \"{}\": the group has no {} elements", group.name,
                              kind == Kind::shell ? "shell" : "line"));
    }
    section[index] = static_cast<int>(s);
  }
  return section;
}

int section_of(const SectionMap& map, const mesh::ElementBlock& block, int element)
{
  const int group = block.group[element];
  if (group < 0) return -1;
  return kind_of(block) == Kind::beam ? map.beam[group] : map.shell[group];
}

/// The axes of all beams of a line are defined.
void check_axes(const NodeVectors& x, const BeamSection& section)
{
  for (Eigen::Index i = 0; i + 1 < x.rows(); ++i) beam_axes(x.row(i + 1) - x.row(i), section);
}

}  // namespace

SectionMap map_sections(const mesh::Mesh& mesh, const Parts& parts)
{
  const SectionMap map{.shell = section_of_group(mesh, parts.shells, Kind::shell),
                       .beam = section_of_group(mesh, parts.beams, Kind::beam)};
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (kind_of(block) == Kind::shell) check_element_exists(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) {
      const int section = section_of(map, block, e);
      if (section < 0) {
        throw Error(
            fmt::format("element {} has no section: name its physical group in a [[section]]",
                        block.numbers[e]));
      }
      if (kind_of(block) == Kind::beam) {
        check_axes(element_positions(mesh, block, e), parts.beams[section]);
      }
    }
  }
  return map;
}

ElementMatrices element_matrices(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                 int element, const ElementContext& context)
{
  const int index = section_of(context.sections, block, element);
  if (kind_of(block) == Kind::beam) {
    return beam_matrices(element_positions(mesh, block, element), context.parts.beams[index]);
  }
  const ShellSection& section = context.parts.shells[index];
  return shell_matrices(block.shape, block.order,
                        shell_nodes(mesh, block, element, context.normals, section.thickness),
                        section.material);
}

}  // namespace chladni::plate
