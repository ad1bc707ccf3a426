#include "cases/picture.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"
#include "mesh/element_types.hpp"

namespace chladni::cases {
PictureNodes picture_nodes(const mesh::Mesh& mesh, scene::PictureChoice choice)
{
  PictureNodes chosen;
  if (choice == scene::PictureChoice::none) return chosen;
  std::vector<int> index(mesh.n_nodes(), -1);
  const auto place_of = [&](int node) {
    if (index[node] < 0) {
      index[node] = static_cast<int>(chosen.nodes.size());
      chosen.nodes.push_back(node);
    }
    return index[node];
  };
  for (const mesh::FreeFace& face : mesh::free_faces(mesh)) {
    const bool with_edges = choice != scene::PictureChoice::vertices;
    const int order = mesh.blocks[face.block].order;
    for (mesh::LatticeCell cell : mesh::face_cells(int(face.nodes.size()), order, with_edges)) {
      for (int& corner : cell) corner = place_of(face.nodes[std::size_t(corner)]);
      chosen.cells.push_back(cell);
    }
  }
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (mesh::is_solid(block.shape)) continue;
    const int step = choice == scene::PictureChoice::vertices ? block.order : 1;
    const std::vector<mesh::LatticeCell> cells = mesh::lattice_cells(block, step);
    for (int e = 0; e < block.n_elements(); ++e) {
      for (mesh::LatticeCell cell : cells) {
        for (int& corner : cell) corner = place_of(block.element_nodes(e)[corner]);
        chosen.cells.push_back(cell);
      }
    }
  }
  return chosen;
}

namespace {

using Eigen::MatrixXd;

/// Those of some nodes that depend on DOFs of this rank: their places among them.
std::vector<int> own_places(const std::vector<int>& nodes, const plate::DofMap& dofs,
                            const OwnRows& own)
{
  std::vector<int> places;
  const int n_c = dofs.n_components();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto is_here = [&](const plate::MotionTerm& term) { return own.has(n_c * term.number); };
    if (std::ranges::any_of(dofs.motion(nodes[k]), is_here)) places.push_back(static_cast<int>(k));
  }
  return places;
}

/// A few nodes at a time: the rows of all DOFs would be larger than the picture.
constexpr std::size_t at_once = 256;

/// Calls visit(some) for some of the places at a time.
template <typename Visit>
void by_pieces(std::span<const int> places, const Visit& visit)
{
  for (std::size_t begin = 0; begin < places.size(); begin += at_once)
    visit(places.subspan(begin, std::min(at_once, places.size() - begin)));
}

/// The displacements of all nodes, whose memory is touched once where one rank has a node.
class AllRows {
 public:
  AllRows(std::ptrdiff_t n_nodes, Eigen::Index n_columns)
      : rows_(3 * n_nodes, n_columns), is_known_(static_cast<std::size_t>(n_nodes), 0)
  {}

  Eigen::Index n_columns() const { return rows_.cols(); }
  /// Adds those of the nodes at some places.
  void add(std::span<const int> places, const double* values)
  {
    std::vector<char> is_known;
    for (const int place : places)
      is_known.push_back(std::exchange(is_known_[static_cast<std::size_t>(place)], 1));
    for (Eigen::Index j = 0; j < rows_.cols(); ++j) {
      for (std::size_t k = 0; k < places.size(); ++k, values += 3) {
        double* node = &rows_(3 * Eigen::Index(places[k]), j);
        for (int c = 0; c < 3; ++c) node[c] = is_known[k] != 0 ? node[c] + values[c] : values[c];
      }
    }
  }
  MatrixXd taken()
  {
    for (Eigen::Index k = 0; k < std::ssize(is_known_); ++k)
      if (is_known_[static_cast<std::size_t>(k)] == 0) rows_.middleRows<3>(3 * k).setZero();
    return std::move(rows_);
  }

 private:
  MatrixXd rows_;
  std::vector<char> is_known_;
};

int numbers_of(std::span<const int> places, Eigen::Index n_columns)
{
  return static_cast<int>(3 * std::ssize(places) * n_columns);
}

/// Adds what the other ranks send to the first.
void receive(AllRows& all)
{
  std::vector<double> values;
  for (int from = 1; from < n_ranks(); ++from) {
    int n = 0;
    MPI_Recv(&n, 1, MPI_INT, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
    std::vector<int> places(static_cast<std::size_t>(n));
    MPI_Recv(places.data(), n, MPI_INT, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
    by_pieces(places, [&](std::span<const int> some) {
      const int n_numbers = numbers_of(some, all.n_columns());
      values.resize(static_cast<std::size_t>(n_numbers));
      MPI_Recv(values.data(), n_numbers, MPI_DOUBLE, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
      all.add(some, values.data());
    });
  }
}

void send_motions(const std::vector<int>& places, const std::vector<MatrixXd>& pieces)
{
  const auto n = static_cast<int>(places.size());
  MPI_Send(&n, 1, MPI_INT, 0, 0, PETSC_COMM_WORLD);
  MPI_Send(places.data(), n, MPI_INT, 0, 0, PETSC_COMM_WORLD);
  for (const MatrixXd& piece : pieces)
    MPI_Send(piece.data(), static_cast<int>(piece.size()), MPI_DOUBLE, 0, 0, PETSC_COMM_WORLD);
}

}  // namespace

mbs_export::Picture make_picture(const PictureNodes& chosen, const plate::DofMap& dofs,
                                 const OwnRows& own)
{
  const auto n = std::ssize(chosen.nodes);
  mbs_export::Picture picture;
  picture.positions.resize(n, 3);
  picture.cells = chosen.cells;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const Eigen::Vector3d x = dofs.position(chosen.nodes[static_cast<std::size_t>(k)]);
    picture.positions.row(k) << x[0], x[1], x[2];
  }
  if (n == 0) return picture;
  const bool is_first = rank() == 0;
  AllRows all(is_first ? n : 0, own.n_columns);
  const std::vector<int> places = own_places(chosen.nodes, dofs, own);
  std::vector<MatrixXd> pieces;
  by_pieces(places, [&](std::span<const int> some) {
    std::vector<int> nodes;
    for (const int place : some) nodes.push_back(chosen.nodes[static_cast<std::size_t>(place)]);
    MatrixXd rows = displacement_rows(nodes, dofs, own.rows_of);
    if (is_first)
      all.add(some, rows.data());
    else
      pieces.push_back(std::move(rows));
  });
  if (!is_first) {
    send_motions(places, pieces);
    return picture;
  }
  receive(all);
  picture.transformation = all.taken();
  return picture;
}

}  // namespace chladni::cases
