#include "cases/picture.hpp"

#include "mesh/element_parts.hpp"

#include <algorithm>

namespace chladni::cases {
PictureNodes picture_nodes(const mesh::Mesh& mesh, scene::PictureChoice choice)
{
  PictureNodes chosen;
  if (choice == scene::PictureChoice::none) return chosen;
  std::vector<int> index(mesh.n_nodes(), -1);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const int step = choice == scene::PictureChoice::vertices ? block.order : 1;
    const std::vector<mesh::LatticeCell> cells = mesh::lattice_cells(block, step);
    for (int e = 0; e < block.n_elements(); ++e) {
      for (mesh::LatticeCell cell : cells) {
        for (int& corner : cell) {
          const int node = block.element_nodes(e)[corner];
          if (index[node] < 0) {
            index[node] = static_cast<int>(chosen.nodes.size());
            chosen.nodes.push_back(node);
          }
          corner = index[node];
        }
        chosen.cells.push_back(cell);
      }
    }
  }
  return chosen;
}

mbs_export::Picture make_picture(const PictureNodes& chosen, const plate::DofMap& dofs,
                                 const RowsOf& rows_of)
{
  const auto n = std::ssize(chosen.nodes);
  mbs_export::Picture picture;
  picture.positions.resize(n, 3);
  picture.cells = chosen.cells;
  picture.transformation.resize(3 * n, rows_of({}).cols());
  // A few nodes at a time: the rows of all of them would be larger than the picture.
  constexpr std::ptrdiff_t most_at_once = 256;
  for (std::ptrdiff_t begin = 0; begin < n; begin += most_at_once) {
    const std::ptrdiff_t end = std::min(begin + most_at_once, n);
    const std::vector<int> nodes(chosen.nodes.begin() + begin, chosen.nodes.begin() + end);
    const Eigen::MatrixXd rows = node_rows(nodes, dofs, rows_of);
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const Eigen::Vector3d x = dofs.position(nodes[k - begin]);
      picture.positions.row(k) << x[0], x[1], x[2];
      picture.transformation.middleRows<3>(3 * k) = rows.middleRows<3>(6 * (k - begin));
    }
  }
  return picture;
}

}  // namespace chladni::cases
