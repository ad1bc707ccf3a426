#include "plate/sections/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::plate {

namespace {

template <typename Section, typename IsOfKind>
std::vector<int> find_sections(const mesh::Mesh& mesh, std::span<const Section> sections,
                               const IsOfKind& is_of_kind, const char* kind)
{
  std::vector<int> section(mesh.groups.size(), -1);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const mesh::Group& group = mesh::find_group(mesh, sections[s].group);
    const auto index = static_cast<std::size_t>(&group - mesh.groups.data());
    const auto in_group = [&](const mesh::ElementBlock& block) {
      return is_of_kind(block.shape) &&
             std::ranges::count(block.group, static_cast<int>(index)) > 0;
    };
    if (std::ranges::none_of(mesh.blocks, in_group)) {
      throw Error(
          fmt::format("section of group \"{}\": the group has no {} elements", group.name, kind));
    }
    section[index] = static_cast<int>(s);
  }
  return section;
}

}  // namespace

std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const ShellSection> sections)
{
  const auto is_surface = [](mesh::Shape shape) { return shape != mesh::Shape::line; };
  return find_sections(mesh, sections, is_surface, "shell");
}

std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const BeamSection> sections)
{
  const auto is_line = [](mesh::Shape shape) { return shape == mesh::Shape::line; };
  return find_sections(mesh, sections, is_line, "line");
}

}  // namespace chladni::plate
