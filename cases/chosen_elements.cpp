#include "cases/chosen_elements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;

Chosen choose_elements(const mesh::Mesh& mesh, const std::string& group,
                       const scene::ResultantChoice& choice,
                       const std::function<Index(const mesh::ElementBlock&)>& points_of)
{
  const auto index = static_cast<int>(&mesh::find_group(mesh, group) - mesh.groups.data());
  Chosen chosen{.group = group, .elements = {}, .nodes = {}};
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const Index n_points = points_of(block);
    for (int e = 0; n_points > 0 && e < block.n_elements(); ++e) {
      const bool wanted =
          choice.elements.empty() ||
          std::ranges::find(choice.elements, block.numbers[e]) != choice.elements.end();
      if (block.group[e] != index || !wanted) continue;
      chosen.elements.push_back({block, e, chosen.n_points});
      chosen.n_points += n_points;
      const auto nodes = block.element_nodes(e);
      chosen.nodes.insert(chosen.nodes.end(), nodes.begin(), nodes.end());
    }
  }
  std::ranges::sort(chosen.nodes);
  chosen.nodes.erase(std::unique(chosen.nodes.begin(), chosen.nodes.end()), chosen.nodes.end());
  if (!chosen.elements.empty()) return chosen;
  throw Error(fmt::format("resultants: the group \"{}\" has {}", group,
                          choice.elements.empty() ? "no elements with section forces"
                                                  : "none of reduce.resultant_elements"));
}

MatrixXd rows_of_element(const Chosen& chosen, const ChosenElement& element, const MatrixXd& rows)
{
  const std::span<const int> nodes = element.block.element_nodes(element.element);
  MatrixXd of_element(6 * std::ssize(nodes), rows.cols());
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    const auto place = std::ranges::lower_bound(chosen.nodes, nodes[static_cast<std::size_t>(i)]) -
                       chosen.nodes.begin();
    of_element.middleRows<6>(6 * i) = rows.middleRows<6>(6 * place);
  }
  return of_element;
}

}  // namespace chladni::cases
