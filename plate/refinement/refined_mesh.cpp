#include "plate/refinement/refined_mesh.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "mesh/element_parts.hpp"
#include "plate/refinement/arc_edges.hpp"
#include "plate/refinement/edge_cuts.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using mesh::ElementBlock, mesh::Mesh, mesh::Shape;
using Parameters = std::vector<std::array<double, 2>>;

constexpr int highest_order(Shape shape)
{
  return shape == Shape::triangle ? 3 : 4;
}

/// An element of the original at work.
struct Work {
  int block, element;
  std::span<const int> old;  ///< its nodes
  const Lattice& coarse;
  const Lattice& fine;
  const Parameters& parameters;  ///< of the fine lattice
  const MatrixXd& shapes;        ///< there
  bool is_uniform;               ///< nodes of the coarse lattice may be places of the fine one
  ArcElement arcs;
};

/// Builds the refined mesh block by block.
class Refiner {
 public:
  Refiner(const Mesh& mesh, const Refinement& refinement)
      : old_(mesh), how_(refinement), cuts_(mesh, how_.edge_rows)
  {
    for (const std::int64_t number : mesh.node_numbers)
      last_number_ = std::max(last_number_, number);
    same_.assign(mesh.positions.size(), -1);
    for (const mesh::Group& group : mesh.groups) {
      std::vector<char> has(mesh.positions.size(), 0);
      for (const int node : group.nodes) has[static_cast<std::size_t>(node)] = 1;
      members_.push_back(std::move(has));
    }
    joined_.resize(mesh.groups.size());
  }

  RefinedMesh result() &&
  {
    for (std::size_t b = 0; b < old_.blocks.size(); ++b) add_block(static_cast<int>(b));
    keep_free_nodes();
    for (std::size_t g = 0; g < old_.groups.size(); ++g) add_group(g);
    return std::move(new_);
  }

 private:
  void add_block(int b)
  {
    const ElementBlock& old = old_.blocks[static_cast<std::size_t>(b)];
    const Lattice coarse(old.shape, old.order), fine(old.shape, how_.parts * how_.order);
    const Parameters halves = lattice_parameters(fine, how_.parts, in_the_middle);
    const MatrixXd shapes_of_halves = shapes_at(old.shape, old.order, halves);
    const std::vector<Part> parts = parts_of(old.shape, how_.parts);
    ElementBlock block{.shape = old.shape,
                       .order = how_.order,
                       .nodes_per_element = Lattice(old.shape, how_.order).size(),
                       .numbers = {},
                       .nodes = {},
                       .group = {}};
    for (int e = 0; e < old.n_elements(); ++e) {
      const Cuts cuts = cuts_.cuts(old, e);
      const bool is_uniform = cuts == in_the_middle;
      const Parameters own = is_uniform ? halves : lattice_parameters(fine, how_.parts, cuts);
      const MatrixXd shapes = is_uniform ? shapes_of_halves : shapes_at(old.shape, old.order, own);
      const std::vector<int> nodes = lattice_nodes({.block = b,
                                                    .element = e,
                                                    .old = old.element_nodes(e),
                                                    .coarse = coarse,
                                                    .fine = fine,
                                                    .parameters = own,
                                                    .shapes = shapes,
                                                    .is_uniform = is_uniform,
                                                    .arcs = ArcElement(old_, old, e)});
      for (const Part& part : parts) {
        add_part(block, nodes, fine, part);
        block.numbers.push_back(how_.parts == 1 ? old.numbers[static_cast<std::size_t>(e)]
                                                : ++last_element_);
        block.group.push_back(old.group[static_cast<std::size_t>(e)]);
      }
    }
    new_.mesh.blocks.push_back(std::move(block));
  }

  void add_part(ElementBlock& block, const std::vector<int>& nodes, const Lattice& fine,
                const Part& part) const
  {
    const Lattice own(block.shape, how_.order);
    for (int j = 0; j < own.n_rows(); ++j) {
      for (int i = 0; i < own.n_columns(j); ++i) {
        const int column = how_.order * part.i + part.sign * i;
        const int row = how_.order * part.j + part.sign * j;
        block.nodes.push_back(nodes[static_cast<std::size_t>(fine.place(column, row))]);
      }
    }
  }

  /// The new nodes of one element, at all places of the fine lattice: those of its edges, which
  /// neighbours may have made already, then those inside.
  std::vector<int> lattice_nodes(const Work& work)
  {
    const ElementBlock& block = old_.blocks[static_cast<std::size_t>(work.block)];
    std::vector<int> nodes(static_cast<std::size_t>(work.fine.size()), -1);
    const std::vector<std::vector<int>> old_edges = mesh::edges_of(block, work.element);
    const std::vector<std::vector<int>> fine_edges = work.fine.edges();
    for (std::size_t k = 0; k < old_edges.size(); ++k) {
      const std::vector<int>& made = edge_nodes(work, old_edges[k], fine_edges[k]);
      const bool is_turned = old_edges[k].front() > old_edges[k].back();
      for (std::size_t i = 0; i < made.size(); ++i) {
        nodes[static_cast<std::size_t>(fine_edges[k][is_turned ? made.size() - 1 - i : i])] =
            made[i];
      }
    }
    std::vector<int> inner;
    const int p = work.coarse.n(), n = work.fine.n();
    for (int j = 0; j < work.fine.n_rows(); ++j) {
      for (int i = 0; i < work.fine.n_columns(j); ++i) {
        int& node = nodes[static_cast<std::size_t>(work.fine.place(i, j))];
        if (node >= 0) continue;
        const bool is_kept = work.is_uniform && i * p % n == 0 && j * p % n == 0;
        node =
            is_kept
                ? node_of(
                      work,
                      work.old[static_cast<std::size_t>(work.coarse.place(i * p / n, j * p / n))],
                      work.fine.place(i, j))
                : add_node(work, work.fine.place(i, j));
        if (!is_kept) inner.push_back(node);
      }
    }
    join(inner, work.old, 2);
    return nodes;
  }

  /// An edge is known by its nodes; the first element that comes makes those that it lacks.
  /// @return from the end with the lower number
  const std::vector<int>& edge_nodes(const Work& work, std::vector<int> old,
                                     std::vector<int> places)
  {
    if (old.front() > old.back()) {
      std::ranges::reverse(old);
      std::ranges::reverse(places);
    }
    const auto [edge, is_new] = edges_.try_emplace(old);
    if (!is_new) return edge->second;
    const bool is_halved = how_.parts == 1 || cuts_.cut(old) == in_the_middle[0];
    const auto n = static_cast<int>(places.size()) - 1, p = static_cast<int>(old.size()) - 1;
    std::vector<int> added;
    for (int i = 0; i <= n; ++i) {
      const int place = places[static_cast<std::size_t>(i)];
      if (i == 0 || i == n || (is_halved && i * p % n == 0)) {
        edge->second.push_back(node_of(work, old[static_cast<std::size_t>(i * p / n)], place));
      } else {
        added.push_back(add_node(work, place));
        edge->second.push_back(added.back());
      }
    }
    join(added, old, 1);
    return edge->second;
  }

  /// The new name of a node that stays.
  int node_of(const Work& work, int old, int place)
  {
    int& node = same_[static_cast<std::size_t>(old)];
    if (node >= 0) return node;
    node = new_.mesh.n_nodes();
    new_.mesh.node_numbers.push_back(old_.node_numbers[static_cast<std::size_t>(old)]);
    new_.mesh.positions.push_back(old_.positions[static_cast<std::size_t>(old)]);
    new_.places.push_back({work.block, work.element, work.shapes.row(place)});
    return node;
  }

  /// Nodes of no element, which follow others, stay; nothing is interpolated there.
  void keep_free_nodes()
  {
    std::vector<char> is_free(old_.positions.size(), 1);
    for (const ElementBlock& block : old_.blocks)
      for (const int node : block.nodes) is_free[static_cast<std::size_t>(node)] = 0;
    for (std::size_t node = 0; node < is_free.size(); ++node) {
      if (is_free[node] == 0) continue;
      same_[node] = new_.mesh.n_nodes();
      new_.mesh.node_numbers.push_back(old_.node_numbers[node]);
      new_.mesh.positions.push_back(old_.positions[node]);
      const Index n = old_.blocks.front().nodes_per_element;
      new_.places.push_back({0, 0, Eigen::RowVectorXd::Zero(n)});
    }
  }

  int add_node(const Work& work, int place)
  {
    const auto [r, s] = work.parameters[static_cast<std::size_t>(place)];
    const Eigen::RowVector3d moved = work.arcs.correction(r, s);
    std::array<double, 3> x{moved[0], moved[1], moved[2]};
    for (std::size_t i = 0; i < work.old.size(); ++i) {
      const auto& node = old_.positions[static_cast<std::size_t>(work.old[i])];
      for (std::size_t c = 0; c < 3; ++c)
        x[c] += work.shapes(place, static_cast<Index>(i)) * node[c];
    }
    new_.mesh.node_numbers.push_back(++last_number_);
    new_.mesh.positions.push_back(x);
    new_.places.push_back({work.block, work.element, work.shapes.row(place)});
    return new_.mesh.n_nodes() - 1;
  }

  /// New nodes between old ones join the groups of at least this dimension that have all of these.
  void join(const std::vector<int>& added, std::span<const int> between, int dimension)
  {
    if (added.empty()) return;
    for (std::size_t g = 0; g < members_.size(); ++g) {
      if (old_.groups[g].dimension < dimension) continue;
      const auto is_member = [&](int node) {
        return members_[g][static_cast<std::size_t>(node)] != 0;
      };
      if (std::ranges::all_of(between, is_member))
        joined_[g].insert(joined_[g].end(), added.begin(), added.end());
    }
  }

  /// Rings keep their order by angle; other groups ascend.
  void add_group(std::size_t g)
  {
    const mesh::Group& old = old_.groups[g];
    mesh::Group group{.name = old.name, .dimension = old.dimension, .nodes = {}};
    for (const int node : old.nodes)
      if (const int kept = same_[static_cast<std::size_t>(node)]; kept >= 0)
        group.nodes.push_back(kept);
    group.nodes.insert(group.nodes.end(), joined_[g].begin(), joined_[g].end());
    if (old.dimension > 0) std::ranges::sort(group.nodes);
    new_.mesh.groups.push_back(std::move(group));
  }

  const Mesh& old_;
  Refinement how_;
  EdgeCuts cuts_;
  RefinedMesh new_;
  std::int64_t last_number_ = 0, last_element_ = 0;
  std::vector<int> same_;                   ///< [old nodes] new ones, -1 where there is none
  std::vector<std::vector<char>> members_;  ///< [groups][old nodes]
  std::vector<std::vector<int>> joined_;    ///< [groups] new nodes
  std::map<std::vector<int>, std::vector<int>> edges_;  ///< old nodes -> new, from the lower end
};

}  // namespace

RefinedMesh refined(const Mesh& mesh, const Refinement& refinement)
{
  return Refiner(mesh, refinement).result();
}

bool has_wide_edges(const Mesh& mesh, const std::vector<double>& rows)
{
  const EdgeCuts cuts(mesh, rows);
  return std::ranges::any_of(mesh.blocks, [&](const ElementBlock& block) {
    for (int e = 0; e < block.n_elements(); ++e)
      if (cuts.cuts(block, e) != in_the_middle) return true;
    return false;
  });
}

bool keeps_points(const Mesh& mesh, const Mesh& refined)
{
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (mesh.groups[g].dimension == 0 &&
        refined.groups[g].nodes.size() < mesh.groups[g].nodes.size())
      return false;
  }
  return true;
}

bool can_rise(const Mesh& mesh)
{
  const int order = mesh.blocks.front().order;
  const bool exists = std::ranges::all_of(mesh.blocks, [&](const ElementBlock& block) {
    return block.order == order && order < highest_order(block.shape);
  });
  return exists && keeps_points(mesh, refined(mesh, {.parts = 1, .order = order + 1}).mesh);
}

MatrixXd interpolated(const Mesh& mesh, const RefinedMesh& refined, const MatrixXd& motions)
{
  MatrixXd fine = MatrixXd::Zero(6 * std::ssize(refined.places), motions.cols());
  for (Index n = 0; n < std::ssize(refined.places); ++n) {
    const RefinedMesh::Place& place = refined.places[static_cast<std::size_t>(n)];
    const std::span<const int> nodes =
        mesh.blocks[static_cast<std::size_t>(place.block)].element_nodes(place.element);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      fine.middleRows<6>(6 * n) +=
          place.shapes[static_cast<Index>(i)] * motions.middleRows<6>(6 * Index(nodes[i]));
    }
  }
  return fine;
}

}  // namespace chladni::plate
