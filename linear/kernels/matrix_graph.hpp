#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace chladni::linear {

/// A graph in compressed form: the neighbours of each vertex, without the vertex itself.
struct Adjacency {
  std::vector<int> starts = {0};  ///< [n_vertices + 1]
  std::vector<int> neighbours;

  int n_vertices() const { return static_cast<int>(starts.size()) - 1; }
};

/// The graph with an edge in both directions wherever there is one in either. The pattern of a
/// symmetric matrix is not symmetric if a zero is stored at (i, j) and not at (j, i), but METIS and
/// the elimination tree require symmetry. Existing neighbours keep their order.
/// @throws chladni::Error when there are more edges than METIS can count.
Adjacency symmetrized(Adjacency graph);

/// The same of a graph whose vertices the ranks have, one rank after the other, on all ranks.
/// @param part  the vertices of this rank; their neighbours are numbered over all ranks
/// @note   Collective.
Adjacency joined(Adjacency part, MPI_Comm comm);

/// True if each edge exists in both directions.
bool is_symmetric(const Adjacency& graph);

/// A number whose bits all depend on all bits of z (the finaliser of splitmix64).
inline std::uint64_t mixed(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Of a set of numbers, in any order; 128 bits, so that two sets do not meet by chance.
struct Fingerprint {
  std::uint64_t a = 0, b = 0;
  bool operator==(const Fingerprint&) const = default;

  void add(std::uint64_t number)
  {
    a += mixed(number + 0x9E3779B97F4A7C15ULL);
    b += mixed(number * 0xD1B54A32D192ED03ULL + 1);
  }
};

struct FingerprintHash {
  std::size_t operator()(const Fingerprint& f) const { return f.a ^ (f.b << 1); }
};

template <typename Value>
using ByFingerprint = std::unordered_map<Fingerprint, Value, FingerprintHash>;

}  // namespace chladni::linear
