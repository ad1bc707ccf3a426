#include "cases/broadcast_mesh.hpp"

#include <mpi.h>

#include <algorithm>
#include <vector>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"
#include "mesh/packed_mesh.hpp"

namespace chladni::cases {
mesh::Mesh broadcast(const mesh::Mesh& mesh)
{
  if (n_ranks() == 1) return mesh;
  std::vector<char> bytes;
  if (rank() == 0) {
    mesh::Packer packer;
    pack(packer, mesh);
    bytes = packer.bytes();
  }
  std::size_t size = bytes.size();
  MPI_Bcast(&size, sizeof(size), MPI_BYTE, 0, PETSC_COMM_WORLD);
  bytes.resize(size);
  constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int
  for (std::size_t at = 0; at < size; at += piece) {
    const auto count = static_cast<int>(std::min(piece, size - at));
    MPI_Bcast(bytes.data() + at, count, MPI_BYTE, 0, PETSC_COMM_WORLD);
  }
  mesh::Unpacker unpacker(bytes);
  return mesh::unpack_mesh(unpacker);
}

}  // namespace chladni::cases
