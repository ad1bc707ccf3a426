#include "linear/cholesky/supernodal/quotient_graph.hpp"

#include <cstdint>
#include <unordered_map>

#include "linear/kernels/gather.hpp"

namespace chladni::linear {

namespace {

std::uint64_t mixed(std::uint64_t z)  // splitmix64
{
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Of a set of columns, in any order; 128 bits, so that two sets do not meet by chance.
struct Fingerprint {
  std::uint64_t a = 0, b = 0;
  bool operator==(const Fingerprint&) const = default;

  void add(std::uint64_t column)
  {
    a += mixed(column + 0x9E3779B97F4A7C15ULL);
    b += mixed(column * 0xD1B54A32D192ED03ULL + 1);
  }
};

struct Hash {
  std::size_t operator()(const Fingerprint& f) const { return f.a ^ (f.b << 1); }
};

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

OwnVertices own_vertices(Mat A)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  OwnVertices own;
  std::unordered_map<Fingerprint, int, Hash> known;
  for (PetscInt row = first; row < last; ++row) {
    Fingerprint pattern;
    with_row(A, row, [&](const PetscInt* begin, const PetscInt* end) {
      for (const PetscInt* column = begin; column != end; ++column) pattern.add(*column);
    });
    const auto [place, is_new] = known.try_emplace(pattern, std::ssize(own.n_rows));
    if (is_new) {
      own.representative.push_back(row);
      own.n_rows.push_back(0);
    }
    ++own.n_rows[place->second];
    own.of_row.push_back(place->second);
  }
  return own;
}

}  // namespace

QuotientGraph quotient_graph(Mat A)
{
  const MPI_Comm comm = petsc::communicator(A);
  OwnVertices own = own_vertices(A);
  const auto n_own = static_cast<int>(own.n_rows.size());
  int before = 0;
  MPI_Exscan(&n_own, &before, 1, MPI_INT, MPI_SUM, comm);
  if (petsc::rank(comm) == 0) before = 0;
  for (int& vertex : own.of_row) vertex += before;
  QuotientGraph graph{.vertex_of_row = gather_on_all(own.of_row, MPI_INT, comm),
                      .n_rows = gather_on_all(own.n_rows, MPI_INT, comm),
                      .edges = {}};
  std::vector<int> seen_by(graph.n_vertices(), -1), degrees, neighbours;
  for (int v = 0; v < n_own; ++v) {
    const int self = before + v;
    const std::size_t n_before = neighbours.size();
    seen_by[self] = self;
    with_row(A, own.representative[v], [&](const PetscInt* begin, const PetscInt* end) {
      for (const PetscInt* column = begin; column != end; ++column) {
        const int other = graph.vertex_of_row[*column];
        if (seen_by[other] == self) continue;
        seen_by[other] = self;
        neighbours.push_back(other);
      }
    });
    degrees.push_back(static_cast<int>(neighbours.size() - n_before));
  }
  degrees = gather_on_all(degrees, MPI_INT, comm);
  graph.edges = symmetrized(
      {.starts = offsets(degrees), .neighbours = gather_on_all(neighbours, MPI_INT, comm)});
  return graph;
}

}  // namespace chladni::linear
