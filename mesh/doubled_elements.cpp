#include "mesh/doubled_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "common/error.hpp"

namespace chladni::mesh {
namespace {

bool has_section(const Mesh& mesh, Shape shape, int group, const MeshOptions& options)
{
  if (group < 0) return false;
  const auto& names = shape == Shape::line ? options.line_groups : options.shell_groups;
  return std::ranges::find(names, mesh.groups[std::size_t(group)].name) != names.end();
}

/// The group of an element that stands in the file twice, as element `first` and `other`.
int common_group(const Mesh& mesh, const ElementBlock& block, const std::array<int, 2>& pair,
                 const MeshOptions& options)
{
  const int first = block.group[std::size_t(pair[0])], other = block.group[std::size_t(pair[1])];
  if (first == other || !has_section(mesh, block.shape, other, options))
    return first < 0 ? other : first;
  if (!has_section(mesh, block.shape, first, options)) return other;
  throw Error(fmt::format(
      "elements {} and {} have the same nodes, and are in the groups \"{}\" and \"{}\", which have "
      "a section each; take one of them out",
      block.numbers[std::size_t(pair[0])], block.numbers[std::size_t(pair[1])],
      mesh.groups[std::size_t(first)].name, mesh.groups[std::size_t(other)].name));
}

void erase_elements(ElementBlock& block, const std::vector<char>& is_erased)
{
  const auto width = static_cast<std::ptrdiff_t>(block.nodes_per_element);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < is_erased.size(); ++e) {
    if (is_erased[e] != 0) continue;
    block.numbers[kept] = block.numbers[e];
    block.group[kept] = block.group[e];
    std::copy_n(block.nodes.begin() + std::ptrdiff_t(e) * width, width,
                block.nodes.begin() + std::ptrdiff_t(kept) * width);
    ++kept;
  }
  block.numbers.resize(kept);
  block.group.resize(kept);
  block.nodes.resize(kept * std::size_t(width));
}

}  // namespace

std::vector<std::array<int, 2>> doubled_elements(const ElementBlock& block)
{
  const auto width = static_cast<std::size_t>(block.nodes_per_element);
  std::vector<int> ascending = block.nodes;
  const auto nodes_of = [&](int e) {
    return std::span(ascending).subspan(std::size_t(e) * width, width);
  };
  for (int e = 0; e < block.n_elements(); ++e) std::ranges::sort(nodes_of(e));
  std::vector<int> order(block.numbers.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) {
    return std::ranges::lexicographical_compare(nodes_of(a), nodes_of(b));
  });
  std::vector<std::array<int, 2>> pairs;
  std::size_t first = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (std::ranges::equal(nodes_of(order[i]), nodes_of(order[first])))
      pairs.push_back({order[first], order[i]});
    else
      first = i;
  std::ranges::sort(pairs, {}, [](const auto& pair) { return pair[1]; });
  return pairs;
}

void merge_doubled_elements(Mesh& mesh, const MeshOptions& options)
{
  for (ElementBlock& block : mesh.blocks) {
    const std::vector<std::array<int, 2>> pairs = doubled_elements(block);
    if (pairs.empty()) continue;
    std::vector<char> is_erased(block.numbers.size(), 0);
    for (const auto& [first, other] : pairs) {
      block.group[std::size_t(first)] = common_group(mesh, block, {first, other}, options);
      is_erased[std::size_t(other)] = 1;
    }
    mesh.notes.push_back(fmt::format(
        "{} elements have the nodes of another one of their type (the first are {} and {}): they "
        "are one element in several groups",
        pairs.size(), block.numbers[std::size_t(pairs[0][0])],
        block.numbers[std::size_t(pairs[0][1])]));
    erase_elements(block, is_erased);
  }
}

}  // namespace chladni::mesh
