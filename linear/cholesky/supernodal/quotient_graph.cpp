#include "linear/cholesky/supernodal/quotient_graph.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "linear/kernels/gather.hpp"
#include "linear/kernels/matrix_graph.hpp"

namespace chladni::linear {

namespace {

/// Rows of this rank that stand for a vertex, and the vertex of each row, both counted on this
/// rank.
struct OwnVertices {
  std::vector<PetscInt> representative;
  std::vector<int> n_rows;
  std::vector<int> of_row;
};

template <typename Work>
void with_row(Mat A, PetscInt row, const Work& work)
{
  PetscInt n = 0;
  const PetscInt* columns = nullptr;
  petsc::check(MatGetRow(A, row, &n, &columns, nullptr));
  work(columns, columns + n);
  petsc::check(MatRestoreRow(A, row, &n, &columns, nullptr));
}

/// The vertices of the last rows with different columns: the next row has often the columns of one
/// of them, which a comparison tells sooner than a fingerprint.
class LastRows {
 public:
  /// -1 where no last row has these columns.
  int vertex_of(std::span<const PetscInt> columns) const
  {
    for (const Known& known : last_)
      if (std::ranges::equal(known.columns, columns)) return known.vertex;
    return -1;
  }
  void add(std::span<const PetscInt> columns, int vertex)
  {
    Known& oldest = last_[next_++ % last_.size()];
    oldest.columns.assign(columns.begin(), columns.end());
    oldest.vertex = vertex;
  }

 private:
  struct Known {
    std::vector<PetscInt> columns;
    int vertex = -1;
  };
  std::array<Known, 4> last_;  // bending and motion in the plane of two nodes
  std::size_t next_ = 0;
};

OwnVertices own_vertices(Mat A)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  OwnVertices own;
  ByFingerprint<int> known;
  LastRows last_rows;
  for (PetscInt row = first; row < last; ++row) {
    with_row(A, row, [&](const PetscInt* begin, const PetscInt* end) {
      const std::span columns(begin, end);
      int vertex = last_rows.vertex_of(columns);
      if (vertex < 0) {
        Fingerprint pattern;
        for (const PetscInt column : columns) pattern.add(column);
        const auto [place, is_new] = known.try_emplace(pattern, std::ssize(own.n_rows));
        vertex = place->second;
        last_rows.add(columns, vertex);
        if (is_new) {
          own.representative.push_back(row);
          own.n_rows.push_back(0);
        }
      }
      ++own.n_rows[vertex];
      own.of_row.push_back(vertex);
    });
  }
  return own;
}

}  // namespace

QuotientGraph quotient_graph(Mat A)
{
  const MPI_Comm comm = petsc::communicator(A);
  OwnVertices own = own_vertices(A);
  const auto n_own = static_cast<int>(own.n_rows.size());
  const int before = first_number(n_own, comm);
  for (int& vertex : own.of_row) vertex += before;
  QuotientGraph graph{.vertex_of_row = gather_on_all(std::move(own.of_row), MPI_INT, comm),
                      .n_rows = gather_on_all(std::move(own.n_rows), MPI_INT, comm),
                      .edges = {}};
  std::vector<int> seen_by(graph.n_vertices(), -1);
  Adjacency here;
  for (int v = 0; v < n_own; ++v) {
    const int self = before + v;
    seen_by[self] = self;
    with_row(A, own.representative[v], [&](const PetscInt* begin, const PetscInt* end) {
      for (const PetscInt* column = begin; column != end; ++column) {
        const int other = graph.vertex_of_row[*column];
        if (seen_by[other] == self) continue;
        seen_by[other] = self;
        here.neighbours.push_back(other);
      }
    });
    here.starts.push_back(static_cast<int>(here.neighbours.size()));
  }
  graph.edges = joined(std::move(here), comm);
  return graph;
}

}  // namespace chladni::linear
